// Parses text as TOML, and reads every key as every type.
#include "config/toml_reader.h"
#include "tests/fuzz/config_errors.h"

namespace {

using namespace pleinair;

void walk(const config::TomlTable& table) {
  for (const std::string& key : table.keys()) {
    if (!table.has(key)) fuzz::fail("a key that is not there");
    if (table.lineOf(key) < 0) fuzz::fail("a line before the first");
    fuzz::expectConfigErrors([&] { table.string(key); });
    fuzz::expectConfigErrors([&] { table.number(key); });
    fuzz::expectConfigErrors([&] { table.integer(key); });
    fuzz::expectConfigErrors([&] { table.boolean(key); });
    fuzz::expectConfigErrors([&] { table.numbers(key, {1, 4}); });
    fuzz::expectConfigErrors([&] { walk(table.table(key)); });
    fuzz::expectConfigErrors([&] {
      for (const config::TomlTable& each : table.tables(key)) walk(each);
    });
    fuzz::expectOneLine(table.error(key, "problem", "nothing").what());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::expectConfigErrors([&] {
    const auto document = config::TomlDocument::parseText(fuzz::asText(data, size), "in.toml");
    walk(document.root());
    document.root().finish();
  });
  // Without any known key: every key is an error.
  fuzz::expectConfigErrors([&] {
    const auto document = config::TomlDocument::parseText(fuzz::asText(data, size), "in.toml");
    document.root().finish();
  });
  return 0;
}
