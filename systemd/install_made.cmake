# Installs what the programs make: manual pages, completion, and the demo's model. `programs`: folder of
# the programs as they were built; `documented`: those with a manual page; `source`: the source tree;
# `model`: name of a file in config/models, or empty.
set(made "${programs}/../made")
file(MAKE_DIRECTORY "${made}")

# print_into(FILE PROGRAM ARGUMENT...): FILE is what the program prints.
function(print_into file program)
  execute_process(COMMAND "${programs}/${program}" ${ARGN} OUTPUT_FILE "${made}/${file}" COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# Several installations at a time use one folder.
file(LOCK "${made}" DIRECTORY GUARD PROCESS)
foreach(program ${documented})
  set(section 1)
  if(program STREQUAL "merlind")
    set(section 8)
  endif()
  print_into(${program}.${section} ${program} --print-manual)
  print_into(${program}.completion ${program} --print-completion)
  list(APPEND pages ${program}.${section})
  file(INSTALL "${made}/${program}.completion" RENAME ${program}
    DESTINATION "${CMAKE_INSTALL_PREFIX}/share/bash-completion/completions")
  if(program STREQUAL "merlind")
    print_into(merlin.json.5 merlind --print-config-manual)
    list(APPEND pages merlin.json.5)
  endif()
endforeach()
foreach(page ${pages})
  string(REGEX REPLACE ".*\\." "" section ${page})
  execute_process(COMMAND gzip -9nf "${made}/${page}" COMMAND_ERROR_IS_FATAL ANY)
  file(INSTALL "${made}/${page}.gz" DESTINATION "${CMAKE_INSTALL_PREFIX}/share/man/man${section}")
endforeach()

# Made anew where the program is newer, since it may reduce another way.
if(model)
  set(reduced "${made}/${model}.mrm")
  if("${programs}/merlin" IS_NEWER_THAN "${reduced}")
    execute_process(COMMAND "${programs}/merlin" mesh reduce "${source}/config/models/${model}.ply" -o "${reduced}"
      OUTPUT_QUIET ERROR_VARIABLE progress RESULT_VARIABLE failed)
    if(failed)
      message(FATAL_ERROR "${model}.ply was not reduced: ${progress}")
    endif()
  endif()
  file(INSTALL "${reduced}" DESTINATION "${CMAKE_INSTALL_PREFIX}/share/merlin")
  file(INSTALL "${source}/config/models/${model}.LICENSE" DESTINATION "${CMAKE_INSTALL_PREFIX}/share/merlin")
endif()
file(LOCK "${made}" DIRECTORY RELEASE)
