# Programs for the R3000: Debian's cross compiler, MIPS I only, neither libgcc nor a libc.
find_program(MIPS_GCC mips-linux-gnu-gcc)
find_program(MIPS_OBJCOPY mips-linux-gnu-objcopy)
find_program(QEMU_MIPS qemu-mips)
foreach(tool MIPS_GCC:gcc-mips-linux-gnu MIPS_OBJCOPY:binutils-mips-linux-gnu QEMU_MIPS:qemu-user)
  string(REPLACE ":" ";" pair ${tool})
  list(GET pair 0 variable)
  list(GET pair 1 package)
  if(NOT ${variable})
    message(FATAL_ERROR "The firmware of sgi-4d35 needs the Debian package ${package}; ./dev build installs it.")
  endif()
endforeach()
execute_process(COMMAND ${MIPS_GCC} -dumpfullversion OUTPUT_VARIABLE MIPS_GCC_VERSION OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)

set(MIPS_FLAGS -march=r3000 -mabi=32 -mfp32 -mno-abicalls -fno-pic -fno-pie -G0 -ffreestanding -fno-stack-protector
  -fno-tree-loop-distribute-patterns -ffp-contract=off -fno-asynchronous-unwind-tables -Wall -Wextra -Wno-missing-field-initializers)
set(MIPS_OPTIMISE -O2)
set(MIPS_LINK_FLAGS -no-pie -nostdlib -static -Wl,--build-id=none -Wl,-z,max-page-size=0x1000
  -T ${PROJECT_SOURCE_DIR}/firmware/lib/mips/program.ld)
set(MIPS_VARIANT "")

# dendro_mips_objects(OUT FILES...): compiles C and assembly; OUT names the list of objects. Other flags in MIPS_OPTIMISE need another
# suffix in MIPS_VARIANT.
function(dendro_mips_objects out)
  set(objects)
  foreach(source IN LISTS ARGN)
    file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR} ${source})
    set(object ${PROJECT_BINARY_DIR}/mips/${name}${MIPS_VARIANT}.o)
    get_filename_component(folder ${object} DIRECTORY)
    file(MAKE_DIRECTORY ${folder})
    if(NOT TARGET mips:${name})
      add_custom_command(OUTPUT ${object}
        COMMAND ${MIPS_GCC} ${MIPS_FLAGS} ${MIPS_OPTIMISE} -I${PROJECT_SOURCE_DIR} -MD -MF ${object}.d -c ${source} -o ${object}
        DEPENDS ${source} DEPFILE ${object}.d COMMENT "mips ${name}${MIPS_VARIANT}" VERBATIM)
    endif()
    list(APPEND objects ${object})
  endforeach()
  set(${out} ${objects} PARENT_SCOPE)
endfunction()

# dendro_mips_program(TARGET FILES...): links FILES (sources, or objects that were compiled before) with firmware/lib/mips to mips/TARGET.elf
# (mapped, at 0x00400000) and mips/TARGET-unmapped.elf (the same objects at 0x80400000) in the build tree.
function(dendro_mips_program target)
  set(sources ${ARGN})
  list(FILTER sources EXCLUDE REGEX "[.]o$")
  dendro_mips_objects(objects ${sources})
  set(compiled ${ARGN})
  list(FILTER compiled INCLUDE REGEX "[.]o$")
  list(APPEND objects ${compiled})
  set(outputs)
  foreach(link mapped:0x00400000: unmapped:0x80400000:-unmapped)
    string(REPLACE ":" ";" parts "${link}")
    list(GET parts 1 base)
    list(GET parts 2 suffix)
    set(output ${PROJECT_BINARY_DIR}/mips/${target}${suffix}.elf)
    add_custom_command(OUTPUT ${output}
      COMMAND ${MIPS_GCC} ${MIPS_FLAGS} ${MIPS_LINK_FLAGS} -Wl,--defsym=BASE=${base} ${objects} ${MIPS_LIBRARY_OBJECTS} -o ${output}
      DEPENDS ${objects} ${MIPS_LIBRARY_OBJECTS} ${PROJECT_SOURCE_DIR}/firmware/lib/mips/program.ld COMMENT "mips ${target}${suffix}.elf" VERBATIM)
    list(APPEND outputs ${output})
  endforeach()
  add_custom_target(${target} ALL DEPENDS ${outputs})
  add_dependencies(${target} dendro_mips_library)
endfunction()

# dendro_mips_embed(LIBRARY NAMES...): an object library with the programs mips/NAME.elf as text, see sim/study/workstation.h.
function(dendro_mips_embed library)
  set(hex_files)
  foreach(name IN LISTS ARGN)
    set(elf ${PROJECT_BINARY_DIR}/mips/${name}.elf)
    add_custom_command(OUTPUT ${elf}.hex COMMAND ${MIPS_OBJCOPY} -I binary -O verilog ${elf} ${elf}.hex DEPENDS ${elf} VERBATIM)
    list(APPEND hex_files ${elf}.hex)
  endforeach()
  dendro_embed(${library} ${hex_files})
  target_link_libraries(${library} PRIVATE dendro_base)
  list(TRANSFORM ARGN REPLACE "-unmapped$" "")
  list(REMOVE_DUPLICATES ARGN)
  add_dependencies(${library} ${ARGN})
endfunction()
