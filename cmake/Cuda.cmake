# ROADSTEREO_CUDA decides whether the engine `cuda` is built:
#   AUTO      when a CUDA compiler is found (in PATH, CUDACXX, or /usr/local/cuda)
#   ON, OFF   always, never
#   EMULATED  its kernels run on the host, one thread after the other: for tests, where there is no GPU
# Sets ROADSTEREO_WITH_CUDA (ON, OFF or EMULATED).
#
# Architectures: CMAKE_CUDA_ARCHITECTURES, or the environment variable CUDAARCHS, if given. Else those of the GPUs of this
# machine; without one, real code for every Jetson, and every desktop or server part from Turing on, that the toolkit knows
# (62 TX2, 72 Xavier, 87 Orin, 101 or 110 Thor; 75, 80, 86, 89, 90, 100, 120), and code of the newest that later ones can translate.
set(ROADSTEREO_CUDA AUTO CACHE STRING "The engine cuda: AUTO, ON, OFF, or EMULATED on the host for tests")
set_property(CACHE ROADSTEREO_CUDA PROPERTY STRINGS AUTO ON OFF EMULATED)

set(ROADSTEREO_WITH_CUDA OFF)
if(ROADSTEREO_CUDA STREQUAL "EMULATED")
  set(ROADSTEREO_WITH_CUDA EMULATED)
elseif(ROADSTEREO_CUDA)
  find_program(ROADSTEREO_NVCC nvcc HINTS ENV CUDACXX ENV CUDA_HOME ENV CUDA_PATH /usr/local/cuda PATH_SUFFIXES bin
               DOC "CUDA compiler")
  if(NOT CMAKE_CUDA_COMPILER AND NOT DEFINED ENV{CUDACXX} AND ROADSTEREO_NVCC)
    set(CMAKE_CUDA_COMPILER ${ROADSTEREO_NVCC})
  endif()
  if(CMAKE_CUDA_COMPILER OR DEFINED ENV{CUDACXX})
    set(ROADSTEREO_WITH_CUDA ON)
  elseif(NOT ROADSTEREO_CUDA STREQUAL "AUTO")
    message(FATAL_ERROR "ROADSTEREO_CUDA is ${ROADSTEREO_CUDA}, but there is no nvcc in PATH, CUDACXX or /usr/local/cuda")
  endif()
endif()

# Architectures of the GPUs of this machine, or what the toolkit can make.
function(roadstereo_cuda_architectures result)
  execute_process(COMMAND nvidia-smi --query-gpu=compute_cap --format=csv,noheader
                  OUTPUT_VARIABLE found ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed AND found MATCHES "^[0-9]+\\.[0-9]")
    string(REGEX REPLACE "[.\n ]" ";" parts "${found}")
    string(REGEX MATCHALL "[0-9]+\\.[0-9]+" capabilities "${found}")
    list(REMOVE_DUPLICATES capabilities)
    list(TRANSFORM capabilities REPLACE "\\." "")
    list(TRANSFORM capabilities APPEND "-real")
    set(${result} "${capabilities}" PARENT_SCOPE)
    return()
  endif()
  set(compiler ${CMAKE_CUDA_COMPILER})
  if(NOT compiler)
    set(compiler $ENV{CUDACXX})
  endif()
  execute_process(COMMAND ${compiler} --list-gpu-code OUTPUT_VARIABLE known ERROR_QUIET)
  set(architectures "")
  foreach(wanted 62 72 75 80 86 87 89 90 100 101 110 120)
    if(known MATCHES "sm_${wanted}[\r\n]")
      list(APPEND architectures ${wanted}-real)
      set(newest ${wanted})
    endif()
  endforeach()
  list(APPEND architectures ${newest}-virtual)
  set(${result} "${architectures}" PARENT_SCOPE)
endfunction()

if(ROADSTEREO_WITH_CUDA STREQUAL "ON")
  if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES AND NOT DEFINED ENV{CUDAARCHS})
    roadstereo_cuda_architectures(found)
    set(CMAKE_CUDA_ARCHITECTURES "${found}" CACHE STRING "GPUs to make code for")
  endif()
  enable_language(CUDA)
  set(CMAKE_CUDA_STANDARD 17)
  set(CMAKE_CUDA_STANDARD_REQUIRED ON)
  set(CMAKE_CUDA_EXTENSIONS OFF)
  find_package(CUDAToolkit 11.4 REQUIRED)
  message(STATUS "Engine cuda: toolkit ${CMAKE_CUDA_COMPILER_VERSION}, code for ${CMAKE_CUDA_ARCHITECTURES}")
elseif(ROADSTEREO_WITH_CUDA STREQUAL "EMULATED")
  message(STATUS "Engine cuda: emulated on the host, for tests")
else()
  message(STATUS "Engine cuda: left out (ROADSTEREO_CUDA=${ROADSTEREO_CUDA}, no CUDA compiler)")
endif()

# roadstereo_cuda_target(<target>): where the target finds CUDA or its imitation, and the warnings of its kernels.
function(roadstereo_cuda_target target)
  if(ROADSTEREO_WITH_CUDA STREQUAL "EMULATED")
    target_compile_definitions(${target} PUBLIC ROADSTEREO_CUDA_EMULATED)
    target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src/core/cuda/emulated>)
    return()
  endif()
  target_link_libraries(${target} PUBLIC CUDA::cudart_static)
endfunction()
