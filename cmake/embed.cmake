# dendro_embed(TARGET FILES...): makes a library TARGET holding the files' bytes. `embedded_file(path)` of
# sim/base/embedded.h finds them by their path from the repository (or build) root.
function(dendro_embed target)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp)
  string(REPLACE ";" "|" files "${ARGN}")
  add_custom_command(
    OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -DOUT=${source} -DFILES=${files} -DROOT=${PROJECT_SOURCE_DIR}
            -DBUILD=${PROJECT_BINARY_DIR} -P ${PROJECT_SOURCE_DIR}/cmake/embed_script.cmake
    DEPENDS ${ARGN} ${PROJECT_SOURCE_DIR}/cmake/embed_script.cmake
    VERBATIM)
  # An object library: a static one would be dropped by the linker, because only its initialiser refers to it.
  add_library(${target} OBJECT ${source})
endfunction()
