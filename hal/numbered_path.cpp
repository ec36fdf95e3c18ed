#include "hal/numbered_path.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace pleinair::hal {
namespace {

constexpr std::size_t kMaxDigits = 18;  // fits into 64 bits

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

Error malformed(std::string_view pattern, std::string problem) {
  return Error{.kind = ErrorKind::kInvalidArgument,
               .subject = std::string(pattern),
               .problem = std::move(problem),
               .remedy = "write the number once, in the file name, as %d or %04d"};
}

/// Parses %d or %0Nd at the front of `text`, after its percent sign: the digits and the length of
/// the conversion. Nothing if it is another conversion.
std::optional<std::pair<std::size_t, std::size_t>> parseConversion(std::string_view text) {
  if (text.starts_with('d')) return std::pair{std::size_t{1}, std::size_t{1}};
  if (!text.starts_with('0')) return std::nullopt;
  std::size_t digits = 0;
  const auto [end, status] = std::from_chars(text.data() + 1, text.data() + text.size(), digits);
  const auto length = static_cast<std::size_t>(end - text.data());
  const bool sound = status == std::errc() && length < text.size() && text[length] == 'd' &&
                     digits >= 1 && digits <= kMaxDigits;
  if (!sound) return std::nullopt;
  return std::pair{digits, length + 1};
}

}  // namespace

Result<NumberedPath> NumberedPath::parse(std::string_view pattern) {
  const std::filesystem::path path(pattern);
  NumberedPath numbered;
  numbered.folder_ = path.parent_path();
  const std::string name = path.filename().string();
  bool found = false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    std::string& literal = found ? numbered.suffix_ : numbered.prefix_;
    if (name[i] != '%') {
      literal += name[i];
      continue;
    }
    const std::string_view rest = std::string_view(name).substr(i + 1);
    if (rest.starts_with('%')) {
      literal += '%';
      ++i;
      continue;
    }
    const auto conversion = parseConversion(rest);
    if (!conversion) return tl::unexpected(malformed(pattern, "has an unknown % conversion"));
    if (found) return tl::unexpected(malformed(pattern, "has more than one number"));
    found = true;
    numbered.minDigits_ = conversion->first;
    i += conversion->second;
  }
  if (!found) return tl::unexpected(malformed(pattern, "has no number in its file name"));
  return numbered;
}

std::filesystem::path NumberedPath::at(std::uint64_t number) const {
  std::string digits = std::to_string(number);
  if (digits.size() < minDigits_) digits.insert(0, minDigits_ - digits.size(), '0');
  return folder_ / (prefix_ + digits + suffix_);
}

std::optional<std::uint64_t> NumberedPath::numberOf(std::string_view fileName) const {
  if (!fileName.starts_with(prefix_) || !fileName.ends_with(suffix_) ||
      fileName.size() <= prefix_.size() + suffix_.size()) {
    return std::nullopt;
  }
  const std::string_view digits =
      fileName.substr(prefix_.size(), fileName.size() - prefix_.size() - suffix_.size());
  const bool canonical = std::ranges::all_of(digits, isDigit) && digits.size() >= minDigits_ &&
                         digits.size() <= kMaxDigits &&
                         (digits.size() == minDigits_ || digits.front() != '0');
  if (!canonical) return std::nullopt;
  std::uint64_t number = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return number;
}

bool looksNumbered(const std::filesystem::path& path) {
  return path.filename().string().find('%') != std::string::npos;
}

}  // namespace pleinair::hal
