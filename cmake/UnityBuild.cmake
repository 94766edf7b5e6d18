# A build with -DCMAKE_UNITY_BUILD=ON compiles several sources as one, in half of the time: what headers leave in every
# source is compiled once. .ci/run does so. Sources of the same target then share their anonymous namespaces.
set(CMAKE_UNITY_BUILD_BATCH_SIZE 10 CACHE STRING "Sources compiled as one, with CMAKE_UNITY_BUILD")

# roadstereo_compile_alone(<source>...): sources of this folder that are never compiled together with others. They include
# themselves for each instruction set (Highway), or have names that others have too.
function(roadstereo_compile_alone)
  set_source_files_properties(${ARGV} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
