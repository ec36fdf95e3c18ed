# Run as a script: writes OUTPUT.cpp, the text of every shader in INPUTS, and OUTPUT.h, which
# declares the function `LISTER()` that lists them, and which others include as HEADER.
string(REPLACE "|" ";" INPUTS "${INPUTS}")
list(LENGTH INPUTS count)

set(declaration "std::span<const EmbeddedShader> ${LISTER}();\n")
set(header "// Made from shader files at build; edit those.\n#pragma once\n\n#include <span>\n\n")
string(APPEND header "#include \"pipeline/gpu/programs/embedded_shader.h\"\n\n")
string(APPEND header "namespace pleinair::gpu {\n\n${declaration}\n}  // namespace pleinair::gpu\n")
file(WRITE "${OUTPUT}.h" "${header}")

set(code "// Made from shader files at build; edit those.\n#include \"${HEADER}\"\n\n#include <array>\n\n")
string(APPEND code "namespace pleinair::gpu {\n\n")
string(APPEND code "std::span<const EmbeddedShader> ${LISTER}() {\n")
string(APPEND code "  static constexpr std::array<EmbeddedShader, ${count}> kShaders{{\n")
foreach(input IN LISTS INPUTS)
  file(READ "${input}" text)
  file(RELATIVE_PATH name "${ROOT}" "${input}")
  string(APPEND code "      {\"${name}\", R\"shader(${text})shader\"},\n")
endforeach()
string(APPEND code "  }};\n  return kShaders;\n}\n\n}  // namespace pleinair::gpu\n")
file(WRITE "${OUTPUT}.cpp" "${code}")
