# ROADSTEREO_CUDA=EMULATED: the kernels are compiled by the host's compiler, against the imitation of CUDA in this folder.
message(STATUS "Engine cuda: emulated on the host, for tests")
set(ROADSTEREO_EMULATION ${CMAKE_CURRENT_LIST_DIR})
# nvcc joins products with the sums they go into; so do the emulated kernels where this machine can.
include(CheckCXXSourceRuns)
set(CMAKE_REQUIRED_FLAGS -mfma)
check_cxx_source_runs("int main() { return __builtin_cpu_supports(\"fma\") ? 0 : 1; }" ROADSTEREO_HAS_FMA)
unset(CMAKE_REQUIRED_FLAGS)
if(ROADSTEREO_HAS_FMA)
  set(ROADSTEREO_EMULATED_OPTIONS -mfma -ffp-contract=fast)
endif()

# roadstereo_kernels_as_cxx(<kernel>...): sources of this folder that are CUDA's, as C++.
function(roadstereo_kernels_as_cxx)
  set_source_files_properties(${ARGN} PROPERTIES LANGUAGE CXX SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON
    COMPILE_OPTIONS "-xc++;-std=c++17;${ROADSTEREO_EMULATED_OPTIONS}")
endfunction()

# roadstereo_emulate_kernels(<target> <kernel>...): the same for the sources of a target, and what runs them.
function(roadstereo_emulate_kernels target)
  roadstereo_kernels_as_cxx(${ARGN})
  set(run_kernel ${ROADSTEREO_EMULATION}/run_kernel.cpp)
  target_sources(${target} PRIVATE ${run_kernel} ${ROADSTEREO_EMULATION}/runtime.cpp)
  if(ROADSTEREO_SANITIZE MATCHES thread)
    # Threads of a kernel are threads to the sanitizer; what makes them is none of its business.
    set_source_files_properties(${run_kernel} PROPERTIES
      COMPILE_OPTIONS -fno-sanitize=thread COMPILE_DEFINITIONS ROADSTEREO_EMULATED_RACES)
  endif()
endfunction()
