# Installs the configuration; after install_unit.cmake, which says where: `configuration`.
# An existing configuration is somebody's work and is kept. It names the schema, and an example may
# name postures.json and gestures.json, which must be in the same folder.
foreach(pair "installed.json>merlin.json" "postures.json>postures.json" "gestures.json>gestures.json"
             "merlin.schema.json>merlin.schema.json")
  string(REPLACE ">" ";" pair "${pair}")
  list(GET pair 0 from)
  list(GET pair 1 to)
  set(path "$ENV{DESTDIR}${configuration}/${to}")
  if(EXISTS "${path}" AND NOT to STREQUAL "merlin.schema.json")
    message(STATUS "Kept: ${path}")
  else()
    message(STATUS "Installing: ${path}")
    file(READ "${source}/config/${from}" content)
    string(REPLACE "/usr/share/" "${CMAKE_INSTALL_PREFIX}/share/" content "${content}")
    file(WRITE "${path}" "${content}")
  endif()
endforeach()

# The examples, which may name what is installed.
foreach(name wall.json wall-flat-overlap.json wall-kms-four.json wall-stereo.json wall-three-160.json postures.json gestures.json merlin.schema.json)
  set(path "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/share/merlin/${name}")
  message(STATUS "Installing: ${path}")
  file(READ "${source}/config/${name}" content)
  string(REPLACE "/usr/share/" "${CMAKE_INSTALL_PREFIX}/share/" content "${content}")
  file(WRITE "${path}" "${content}")
endforeach()
