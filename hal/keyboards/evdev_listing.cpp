#include "hal/keyboards/evdev_listing.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace pleinair::hal {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "event";

std::optional<int> numberOf(const std::string& name) {
  int number = 0;
  if (!name.starts_with(kPrefix)) return std::nullopt;
  const char* end = name.data() + name.size();
  const auto read = std::from_chars(name.data() + kPrefix.size(), end, number);
  if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
  return number;
}

std::string lineOf(const fs::path& path) {
  std::string line;
  std::getline(std::ifstream(path) >> std::ws, line);
  return line;
}

/// The bits of keys and of buttons, from words in hexadecimal, the highest first.
struct KeyBits {
  bool anyKey = false;
  bool anyButton = false;    ///< of mice, gamepads and such
  std::uint64_t lowest = 0;  ///< by KEY_…: Escape is bit 1
};

KeyBits keyBitsOf(const std::string& text) {
  constexpr std::size_t kWords = 4;  // 256 bits: from there on they are buttons (BTN_MISC)
  std::istringstream words(text);
  std::vector<std::uint64_t> all;
  for (std::uint64_t word = 0; words >> std::hex >> word;) all.push_back(word);
  std::ranges::reverse(all);
  const auto isSet = [](std::uint64_t word) { return word != 0; };
  const auto keysEnd = all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), kWords));
  return {.anyKey = std::any_of(all.begin(), keysEnd, isSet),
          .anyButton = std::any_of(keysEnd, all.end(), isSet),
          .lowest = all.empty() ? 0 : all.front()};
}

/// "05f3:00ff"; empty where the device has no vendor.
std::string idOf(const fs::path& device) {
  const std::string vendor = lineOf(device / "id" / "vendor");
  const std::string product = lineOf(device / "id" / "product");
  if (vendor.empty() || product.empty() || vendor == "0000") return {};
  return vendor + ":" + product;
}

/// As udev judges (ID_INPUT_KEYBOARD): all of the keys 1 to 31, Escape to S.
bool isKeyboard(const KeyBits& bits) {
  constexpr std::uint64_t kFirstKeys = 0xFFFFFFFE;
  return (bits.lowest & kFirstKeys) == kFirstKeys;
}

}  // namespace

std::vector<KeyboardDescription> listEvdevKeyboards(const fs::path& folder) {
  std::vector<std::pair<int, KeyboardDescription>> found;
  std::error_code failure;
  for (fs::directory_iterator each(folder, failure), end; !failure && each != end;
       each.increment(failure)) {
    const std::string name = each->path().filename().string();
    const std::optional<int> number = numberOf(name);
    if (!number) continue;
    const fs::path device = each->path() / "device";
    const KeyBits bits = keyBitsOf(lineOf(device / "capabilities" / "key"));
    if (!bits.anyKey && !bits.anyButton) continue;
    found.push_back({*number,
                     {.node = "/dev/input/" + name,
                      .name = lineOf(device / "name"),
                      .isKeyboard = isKeyboard(bits),
                      .hasKeys = bits.anyKey,
                      .id = idOf(device)}});
  }
  std::ranges::sort(found, {}, &std::pair<int, KeyboardDescription>::first);
  std::vector<KeyboardDescription> keyboards;
  for (auto& [number, each] : found) keyboards.push_back(std::move(each));
  return keyboards;
}

}  // namespace pleinair::hal
