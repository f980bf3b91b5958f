# Installs every document, with its pictures and the examples of clients, under its path in the source tree, so
# that a path that a document or a message names is found from share/doc/merlin. After install.cmake. `source`:
# the source tree.
foreach(folder config daemon drivers nn render systemd)
  file(GLOB_RECURSE found RELATIVE "${source}" "${source}/${folder}/*.md")
  list(APPEND files ${found})
endforeach()
file(GLOB found RELATIVE "${source}" "${source}/config/*.png" "${source}/config/*.json"
  "${source}/daemon/shm/read_merlin.*" "${source}/tests/vm/*.png")
list(APPEND files ${found} daemon/base/field_table.h daemon/shm/channel.h daemon/shm/layout.h daemon/shm/seq_slot.h
  drivers/port/samples.h daemon/status/read_status.py daemon/status/status.schema.json
  drivers/cyberglove/CALIBRATION-LICENSE.txt)
foreach(path ${files})
  cmake_path(GET path PARENT_PATH folder)
  cmake_path(GET path FILENAME name)
  set(documents "${CMAKE_INSTALL_PREFIX}/share/doc/merlin/${folder}")
  set(example "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/share/merlin/${name}")
  if(folder STREQUAL "config" AND EXISTS "${example}")
    file(MAKE_DIRECTORY "$ENV{DESTDIR}${documents}")
    file(CREATE_LINK "../../../merlin/${name}" "$ENV{DESTDIR}${documents}/${name}" SYMBOLIC)
  else()
    file(INSTALL "${source}/${path}" DESTINATION "${documents}" MESSAGE_NEVER
      PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
  endif()
endforeach()
