# roadstereo_highway(<target>): the kernels' vectors, from Highway or, in a build that has nothing but a compiler, from
# src/core/one_lane, which has Highway's names for vectors of one lane.
set(ROADSTEREO_ONE_LANE ${PROJECT_SOURCE_DIR}/src/core/one_lane)
if(NOT ROADSTEREO_STANDALONE)
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)
endif()

function(roadstereo_highway target)
  if(ROADSTEREO_STANDALONE)
    target_include_directories(${target} PRIVATE ${ROADSTEREO_ONE_LANE})
  else()
    target_link_libraries(${target} PRIVATE PkgConfig::HWY)
    # Instruction sets that the kernels are not written for: their vectors have no size at compile time.
    target_compile_definitions(${target} PRIVATE
      "HWY_DISABLED_TARGETS=(HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128)")
  endif()
endfunction()
