# CTest includes this when it starts. A suite of GoogleTest is one of its tests, since loading the shared libraries of a
# program takes longer than most tests; what of a suite has other labels is another one. Labels are that of the program and
# those that the full name of a test says:
#   RealData  real_data  needs the folder ROADSTEREO_DATA
#   TwoGpus   two_gpus   needs a second GPU
#   GStreamer gstreamer  needs GStreamer and its base plugins
#   Ogrinfo   ogrinfo    needs GDAL's own reader
#   Rgbd      rgbd       needs OpenCV's module rgbd
#   Slow      slow       lasts too long for every change, or under sanitizers
#   Threads   threads    is about threads: the thread sanitizer runs it
#   /cuda     engine_cuda  is that of every engine, with the engine cuda
#   OfDevice  engine_cuda  needs the engine cuda
cmake_policy(VERSION 3.22)  # CTest sets none

function(roadstereo_labels test labels)
  set(found "")
  foreach(name_and_label RealData=real_data TwoGpus=two_gpus GStreamer=gstreamer Ogrinfo=ogrinfo Rgbd=rgbd
                         Slow=slow Threads=threads /cuda=engine_cuda OfDevice=engine_cuda)
    string(REPLACE "=" ";" name_and_label ${name_and_label})
    list(POP_FRONT name_and_label name)
    if(test MATCHES ${name})
      list(APPEND found ${name_and_label})
    endif()
  endforeach()
  set(${labels} ${found} PARENT_SCOPE)
endfunction()

# roadstereo_suites(<program> <file> <folder> <environment> [<emulator>...]): adds the suites of a program. `folder` is
# where its tests run, and where the list of them is kept while the program is the same.
function(roadstereo_suites program file folder environment)
  if(NOT EXISTS ${file})
    add_test(${program}_NOT_BUILT ${program}_NOT_BUILT)
    return()
  endif()
  set(list ${folder}/${program}.list)
  if(${file} IS_NEWER_THAN ${list})
    execute_process(COMMAND ${ARGN} ${file} --gtest_list_tests OUTPUT_VARIABLE lines RESULT_VARIABLE result TIMEOUT 60)
    if(NOT result EQUAL 0)
      message(FATAL_ERROR "${file} --gtest_list_tests: ${result}")
    endif()
    file(WRITE ${list}.new "${lines}")
    file(RENAME ${list}.new ${list})
  endif()
  file(READ ${list} lines)
  string(REGEX REPLACE "(#|Running main)[^\n]*" "" lines "${lines}")  # values of parameters
  string(REPLACE "\n" ";" lines "${lines}")
  set(groups "")
  foreach(line IN LISTS lines)
    if(line MATCHES "^([^ ]+)\\. *$")
      set(suite ${CMAKE_MATCH_1})
    elseif(line MATCHES "^  ([^ ]+)")
      set(test ${suite}.${CMAKE_MATCH_1})
      roadstereo_labels(${test} labels)
      list(JOIN labels "." group)
      string(REGEX REPLACE "\\.$" "" group "${suite}.${group}")
      list(APPEND groups ${group})
      list(APPEND tests_of_${group} ${test})
      set(labels_of_${group} ${labels})
    endif()
  endforeach()
  string(REGEX REPLACE "^test_" "" label ${program})
  list(REMOVE_DUPLICATES groups)
  foreach(group IN LISTS groups)
    get_property(others GLOBAL PROPERTY roadstereo_suites)
    if(group IN_LIST others)
      message(FATAL_ERROR "${program}: another program has a suite ${group}, too")
    endif()
    set_property(GLOBAL APPEND PROPERTY roadstereo_suites ${group})
    list(JOIN tests_of_${group} ":" filter)
    set(labels ${label} ${labels_of_${group}})
    add_test(${group} ${ARGN} ${file} --gtest_filter=${filter})
    set_tests_properties(${group} PROPERTIES LABELS "${labels}" TIMEOUT 1800 WORKING_DIRECTORY ${folder}
      ENVIRONMENT "${environment}"
      # Skipped where all tests are; where only some are, the others would not be seen to fail.
      SKIP_REGULAR_EXPRESSION "\\[  PASSED  \\] 0 tests\\.(\n\\[  SKIPPED \\][^\n]*)+\n*$"
      FAIL_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
  endforeach()
endfunction()
