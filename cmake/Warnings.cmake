# roadstereo_target(<target>): the warnings and sanitizers that every target of the project has.
function(roadstereo_target target)
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wconversion -Wshadow>)
  if(CMAKE_UNITY_BUILD)  # what other sources have in their anonymous namespaces hides nothing
    target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-Wno-shadow -Wshadow=local>)
  endif()
  # What nvcc leaves to the host's compiler has conversions of its own; -Wconversion sees the kernels when they are
  # emulated on the host (ROADSTEREO_CUDA=EMULATED).
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Wall,-Wextra,-Wshadow>)
  # GCC 12 sees overlapping copies in std::string that are not there (GCC bug 105651).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-Wno-restrict>)
  endif()
  if(ROADSTEREO_WERROR)
    target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-Werror>
                                             $<$<COMPILE_LANGUAGE:CUDA>:-Werror=all-warnings -Xcompiler=-Werror>)
  endif()
  if(ROADSTEREO_SANITIZE)
    target_compile_options(${target} PRIVATE
      $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${ROADSTEREO_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all>)
    target_link_options(${target} PRIVATE -fsanitize=${ROADSTEREO_SANITIZE})
    # Eigen allocates in another way under the address sanitizer; Ceres was built without it and frees its memory.
    target_compile_definitions(${target} PRIVATE EIGEN_MALLOC_ALREADY_ALIGNED=1)
    if(ROADSTEREO_SANITIZE MATCHES thread AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-Wno-tsan>)  # the fences of Boost.Asio
    endif()
  endif()
endfunction()

# roadstereo_computes(<target>): what lasts longer to run than to compile is optimised fully in a release, whatever is set
# for the rest (.ci/run compiles files, reports and commands with -O1), and a little with sanitizers.
function(roadstereo_computes target)
  if(ROADSTEREO_SANITIZE)
    target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-O1>)
  else()
    target_compile_options(${target} PRIVATE $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CONFIG:Release>>:-O3>)
  endif()
endfunction()
