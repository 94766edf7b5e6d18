# Labels of the tests, read by CTest. A test has the label of its program and those that its full name says:
#   RealData  real_data  needs the folder ROADSTEREO_DATA
#   TwoGpus   two_gpus   needs a second GPU
#   GStreamer gstreamer  needs GStreamer and its base plugins
#   Ogrinfo   ogrinfo    needs GDAL's own reader
#   Slow      slow       lasts too long for every change, or under sanitizers
#   Threads   threads    is about threads: the thread sanitizer runs it
#   /cuda     engine_cuda  is that of every engine, with the engine cuda
#   OfDevice  engine_cuda  needs the engine cuda
foreach(program embedded allocations cuda graph io live flight cli dds evaluate mapping)
  foreach(test IN LISTS test_${program}_TESTS)
    set(labels ${program})
    foreach(name_and_label RealData:real_data TwoGpus:two_gpus GStreamer:gstreamer Ogrinfo:ogrinfo Slow:slow
                           Threads:threads /cuda:engine_cuda OfDevice:engine_cuda)
      string(REPLACE ":" ";" name_and_label ${name_and_label})
      list(GET name_and_label 0 name)
      if(test MATCHES ${name})
        list(GET name_and_label 1 label)
        list(APPEND labels ${label})
      endif()
    endforeach()
    set_tests_properties(${test} PROPERTIES LABELS "${labels}")
  endforeach()
endforeach()
