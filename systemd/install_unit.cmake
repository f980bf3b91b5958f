# Installs the unit `unit_name`, which depends on the prefix, and that is known at installation. The
# configuration of the prefix /usr is in /etc, that of any other prefix below it. `source` is the
# source tree.
set(configuration "${CMAKE_INSTALL_PREFIX}/etc/merlin")
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(configuration /etc/merlin)
endif()

file(READ "${source}/systemd/${unit_name}" unit)
string(REPLACE "/usr/bin/" "${CMAKE_INSTALL_PREFIX}/bin/" unit "${unit}")
string(REPLACE "/etc/merlin/" "${configuration}/" unit "${unit}")
set(path "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/lib/systemd/system/${unit_name}")
message(STATUS "Installing: ${path}")
file(WRITE "${path}" "${unit}")
