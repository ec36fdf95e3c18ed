// Resolves a whole configuration. The input is a site file; after its first zero byte come
// environment variables (PLEINAIR_…) and settings (--set), each ended by a zero byte. The resolved
// configuration is printed, and the printed one must resolve to the same.
#include <string>
#include <string_view>

#include "config/config_error.h"
#include "firmware_app/config/configuration.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace pleinair;

/// Keeps the site file of the machine out.
constexpr const char* kNoSiteFile = "/nonexistent/site.toml";

fuzz::MemoryFile fileOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

app::ConfigurationRequest requestOf(std::string_view rest) {
  app::ConfigurationRequest request;
  request.defaultSiteFile = kNoSiteFile;
  while (!rest.empty()) {
    const std::string item(rest.substr(0, rest.find('\0')));
    rest.remove_prefix(std::min(item.size() + 1, rest.size()));
    const std::size_t equals = std::min(item.find('='), item.size());
    if (item.starts_with("PLEINAIR_")) {
      const std::string value = item.substr(std::min(equals + 1, item.size()));
      request.environment.push_back({item.substr(0, equals), value});
    } else {
      request.set.push_back(item);
    }
  }
  return request;
}

void expectSame(const app::Configuration& a, const app::Configuration& b) {
  if (!(a.styleParameters() == b.styleParameters())) fuzz::fail("other parameters");
  const app::PaintingSettings p = a.painting();
  const app::PaintingSettings q = b.painting();
  const bool same = p.style == q.style && p.view == q.view && p.size == q.size;
  if (!same) fuzz::fail("another painting");
  if (a.camera().framesPerSecond != b.camera().framesPerSecond) fuzz::fail("another camera");
}

void resolve(std::string_view text, std::string_view rest) {
  const fuzz::MemoryFile file = fileOf(text);
  app::ConfigurationRequest request = requestOf(rest);
  request.siteFile = file.path();
  const app::Configuration configuration(request);
  for (const auto which : {config::Printed::kAll, config::Printed::kGiven}) {
    const std::string toml = configuration.toToml(which);
    const fuzz::MemoryFile copy = fileOf(toml);
    app::ConfigurationRequest again = requestOf({});
    again.siteFile = copy.path();
    try {
      expectSame(configuration, app::Configuration(again));
    } catch (const config::ConfigError& error) {
      fuzz::fail("what was printed is refused: " + std::string(error.what()));
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view all = fuzz::asText(data, size);
  const std::size_t end = std::min(all.find('\0'), all.size());
  try {
    resolve(all.substr(0, end), all.substr(std::min(end + 1, all.size())));
  } catch (const config::ConfigError& error) {
    fuzz::expectOneLine(error.what());
  }
  return 0;
}
