# The pages of the public API: cmake --build build --target docs, where doxygen is installed.
find_program(ROADSTEREO_DOXYGEN doxygen)
mark_as_advanced(ROADSTEREO_DOXYGEN)
if(ROADSTEREO_DOXYGEN)
  set(ROADSTEREO_DOCS_DIR ${PROJECT_BINARY_DIR}/docs)
  file(MAKE_DIRECTORY ${ROADSTEREO_DOCS_DIR})
  configure_file(${PROJECT_SOURCE_DIR}/docs/Doxyfile.in ${ROADSTEREO_DOCS_DIR}/Doxyfile @ONLY)
  add_custom_target(docs COMMAND ${ROADSTEREO_DOXYGEN} ${ROADSTEREO_DOCS_DIR}/Doxyfile
                    COMMENT "Pages of the public API: ${ROADSTEREO_DOCS_DIR}/html/index.html" VERBATIM)
endif()
