// Text as TOML, every key of it asked for as every type.
#include "config/config_error.h"
#include "config/toml_reader.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace pleinair;

template <class Task>
void expectConfigErrors(Task task) {
  try {
    task();
  } catch (const config::ConfigError& error) {
    fuzz::expectOneLine(error.what());
  }
}

void walk(const config::TomlTable& table) {
  for (const std::string& key : table.keys()) {
    if (!table.has(key)) fuzz::fail("a key that is not there");
    if (table.lineOf(key) < 0) fuzz::fail("a line before the first");
    expectConfigErrors([&] { table.string(key); });
    expectConfigErrors([&] { table.number(key); });
    expectConfigErrors([&] { table.integer(key); });
    expectConfigErrors([&] { table.boolean(key); });
    expectConfigErrors([&] { table.numbers(key, {1, 4}); });
    expectConfigErrors([&] { walk(table.table(key)); });
    expectConfigErrors([&] {
      for (const config::TomlTable& each : table.tables(key)) walk(each);
    });
    fuzz::expectOneLine(table.error(key, "problem", "nothing").what());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  expectConfigErrors([&] {
    const auto document = config::TomlDocument::parseText(fuzz::asText(data, size), "in.toml");
    walk(document.root());
    document.root().finish();
  });
  // Nothing asked for: every key is unknown.
  expectConfigErrors([&] {
    const auto document = config::TomlDocument::parseText(fuzz::asText(data, size), "in.toml");
    document.root().finish();
  });
  return 0;
}
