# Installs what depends on the prefix, which is known at installation. The configuration of the prefix
# /usr is in /etc, that of any other prefix below it. `source` is the source tree.
set(configuration "${CMAKE_INSTALL_PREFIX}/etc/merlin")
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(configuration /etc/merlin)
endif()

file(READ "${source}/systemd/merlind.service" unit)
string(REPLACE "/usr/bin/" "${CMAKE_INSTALL_PREFIX}/bin/" unit "${unit}")
string(REPLACE "/etc/merlin/" "${configuration}/" unit "${unit}")
set(path "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/lib/systemd/system/merlind.service")
message(STATUS "Installing: ${path}")
file(WRITE "${path}" "${unit}")

# An existing configuration is somebody's work and is kept. wall.json names postures.json and the
# schema, which must be in the same folder.
foreach(pair "wall.json>merlin.json" "postures.json>postures.json"
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
    file(WRITE "${path}" "${content}")
  endif()
endforeach()
