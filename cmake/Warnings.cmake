# roadstereo_target(<target>): the warnings and sanitizers that every target of the project has.
function(roadstereo_target target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow)
  # GCC 12 sees overlapping copies in std::string that are not there (GCC bug 105651).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict)
  endif()
  if(ROADSTEREO_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(ROADSTEREO_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${ROADSTEREO_SANITIZE} -fno-omit-frame-pointer
                                             -fno-sanitize-recover=all)
    target_link_options(${target} PRIVATE -fsanitize=${ROADSTEREO_SANITIZE})
  endif()
endfunction()
