#include "hal/media/picture_paths.h"

#include <algorithm>
#include <array>
#include <string>
#include <system_error>

namespace pleinair::hal {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 13> kPictureEndings = {
    ".png",  ".jpg",  ".jpeg", ".bmp", ".tif", ".tiff", ".webp",
    ".heic", ".heif", ".avif", ".ppm", ".pgm", ".pnm"};

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

std::string_view takeNumber(std::string_view& text) {
  std::size_t length = 0;
  while (length < text.size() && isDigit(text[length])) ++length;
  std::string_view digits = text.substr(0, length);
  text.remove_prefix(length);
  while (digits.size() > 1 && digits.front() == '0') digits.remove_prefix(1);
  return digits;
}

Result<std::vector<fs::path>> filesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code status;
  for (fs::directory_iterator entry(folder, status), end; !status && entry != end;
       entry.increment(status)) {
    std::error_code ignored;
    const bool hidden = entry->path().filename().string().starts_with('.');
    if (!hidden && entry->is_regular_file(ignored)) files.push_back(entry->path());
  }
  if (status) return tl::unexpected(errnoError(folder.string(), "cannot list", status.value()));
  return files;
}

}  // namespace

bool isPictureName(const fs::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return std::ranges::find(kPictureEndings, ending) != kPictureEndings.end();
}

bool naturallyLess(std::string_view a, std::string_view b) {
  const std::string_view wholeA = a;
  const std::string_view wholeB = b;
  while (!a.empty() && !b.empty()) {
    if (isDigit(a.front()) && isDigit(b.front())) {
      const std::string_view numberA = takeNumber(a);
      const std::string_view numberB = takeNumber(b);
      if (numberA.size() != numberB.size()) return numberA.size() < numberB.size();
      if (numberA != numberB) return numberA < numberB;
      continue;
    }
    if (a.front() != b.front()) return a.front() < b.front();
    a.remove_prefix(1);
    b.remove_prefix(1);
  }
  if (a.empty() != b.empty()) return a.empty();
  return wholeA < wholeB;  // "01" and "1": any fixed order will do
}

Result<std::vector<fs::path>> picturesIn(const fs::path& folder) {
  Result<std::vector<fs::path>> files = filesIn(folder);
  if (!files) return files;
  std::erase_if(*files, [](const fs::path& path) { return !isPictureName(path); });
  if (files->empty()) {
    return tl::unexpected(Error{.kind = ErrorKind::kInvalidInput,
                                .subject = folder.string(),
                                .problem = "is a folder without pictures",
                                .remedy = "give a folder that holds PNG or JPEG files"});
  }
  std::ranges::sort(*files, [](const fs::path& a, const fs::path& b) {
    return naturallyLess(a.filename().string(), b.filename().string());
  });
  return files;
}

std::vector<std::string> otherFilesIn(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) return names;
  const Result<std::vector<fs::path>> files = filesIn(folder);
  if (!files) return names;
  for (const fs::path& file : *files) {
    if (!isPictureName(file)) names.push_back(file.filename().string());
  }
  std::ranges::sort(names, naturallyLess);
  return names;
}

Result<std::vector<fs::path>> picturesOf(const NumberedPath& pattern,
                                         std::string_view patternText) {
  const Result<std::vector<fs::path>> files =
      filesIn(pattern.folder().empty() ? fs::path(".") : pattern.folder());
  if (!files) return tl::unexpected(files.error());
  std::vector<std::uint64_t> numbers;
  for (const fs::path& file : *files) {
    if (const auto number = pattern.numberOf(file.filename().string())) numbers.push_back(*number);
  }
  if (numbers.empty()) {
    return tl::unexpected(Error{.kind = ErrorKind::kNotFound,
                                .subject = std::string(patternText),
                                .problem = "no file has such a name",
                                .remedy = "check the folder and the number of digits"});
  }
  std::ranges::sort(numbers);
  std::vector<fs::path> paths;
  for (const std::uint64_t number : numbers) {
    if (number != numbers.front() + paths.size()) break;
    paths.push_back(pattern.at(number));
  }
  return paths;
}

}  // namespace pleinair::hal
