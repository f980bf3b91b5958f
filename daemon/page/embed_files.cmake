# cmake -DOUTPUT=FILE.cpp -DFOLDER=www -DFILES="a;b" -P embed_files.cmake: writes pageFiles() of
# page_files.h, with the bytes of the files.
set(types_html "text/html; charset=utf-8")
set(types_js "text/javascript; charset=utf-8")
set(types_css "text/css; charset=utf-8")
set(types_svg "image/svg+xml")
set(types_webmanifest "application/manifest+json")

set(arrays "")
set(table "")
foreach(name ${FILES})
  file(READ "${FOLDER}/${name}" hex HEX)
  string(LENGTH "${hex}" length)
  math(EXPR size "${length} / 2")
  # A literal for every 32 bytes: CMake's regular expressions cannot count.
  string(REPEAT "[0-9a-f][0-9a-f]" 32 line_form)
  string(REGEX REPLACE "(${line_form})" "\\1;" pieces "${hex}")
  set(lines "")
  foreach(piece ${pieces})
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" bytes "${piece}")
    string(APPEND lines "    \"${bytes}\"\n")
  endforeach()
  file(SHA256 "${FOLDER}/${name}" hash)
  string(SUBSTRING "${hash}" 0 16 tag)
  string(MAKE_C_IDENTIFIER "k_${name}" variable)
  get_filename_component(ending "${name}" LAST_EXT)
  string(SUBSTRING "${ending}" 1 -1 ending)
  string(APPEND arrays "constexpr char ${variable}[] =\n${lines}    ;\n")
  string(APPEND table
    "    {\"/${name}\", \"${types_${ending}}\", \"\\\"${tag}\\\"\", {${variable}, ${size}}},\n")
endforeach()
file(WRITE "${OUTPUT}" "// Made by embed_files.cmake from daemon/page/www.
#include \"daemon/page/page_files.h\"

namespace merlin::page {
namespace {
${arrays}
constexpr PageFile kFiles[] = {
${table}};
}  // namespace
std::span<const PageFile> pageFiles() { return kFiles; }
}  // namespace merlin::page
")
