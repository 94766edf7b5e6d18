# embed_bytes(<target> <namespace> <header> <name> <file>): a binary file as `const std::string_view name`, likewise.
function(embed_bytes target namespace header name file)
  set(path "${CMAKE_CURRENT_SOURCE_DIR}/${file}")
  file(READ "${path}" content HEX)
  string(REGEX REPLACE "(..)" "0x\\1," content "${content}")
  set(text "#include \"${header}\"\n\nnamespace ${namespace} {\nnamespace {\nconst unsigned char bytes[] = {${content}};\n}\n")
  string(APPEND text "const std::string_view ${name}(reinterpret_cast<const char*>(bytes), sizeof(bytes));\n}\n")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${path}")
  write_embedded(${target} ${namespace} "${text}")
endfunction()

# Writes the generated source of a namespace, and adds it to the target.
function(write_embedded target namespace text)
  string(MAKE_C_IDENTIFIER "${namespace}" file_name)
  set(generated "${CMAKE_CURRENT_BINARY_DIR}/${file_name}.cpp")
  set(old "")
  if(EXISTS "${generated}")
    file(READ "${generated}" old)
  endif()
  if(NOT old STREQUAL text)  # an equal file keeps its time, so that nothing is compiled anew
    file(WRITE "${generated}" "${text}")
  endif()
  target_sources(${target} PRIVATE "${generated}")
endfunction()

# embed_text(<target> <namespace> <header> (<name> <file>)...): each file as `const std::string_view name` in the
# namespace, declared by the header and compiled into the target. Done when CMake runs; a change of a file makes it run.
function(embed_text target namespace header)
  set(text "#include \"${header}\"\n\nnamespace ${namespace} {\n")
  while(ARGN)
    list(POP_FRONT ARGN name file)
    set(path "${CMAKE_CURRENT_SOURCE_DIR}/${file}")
    file(READ "${path}" content)
    string(APPEND text "\nconst std::string_view ${name} = R\"embedded(${content})embedded\";\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${path}")
  endwhile()
  string(APPEND text "\n}  // namespace ${namespace}\n")
  write_embedded(${target} ${namespace} "${text}")
endfunction()
