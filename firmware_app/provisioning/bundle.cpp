#include "firmware_app/provisioning/bundle.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "config/toml_text.h"
#include "hal/file_descriptor.h"
#include "pipeline/digest/sha256.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

/// What Windows writes where it hides endings.
constexpr std::string_view kHiddenEnding = "site.toml.txt";

std::string lowered(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

/// Of the system that wrote the medium.
bool isLeftOut(std::string_view name) {
  return name.starts_with('.') || name == "System Volume Information" || name == "lost+found" ||
         name.starts_with('$');
}

hal::Error invalid(const std::string& name, std::string problem, std::string remedy) {
  return {.kind = hal::ErrorKind::kInvalidInput,
          .subject = name,
          .problem = std::move(problem),
          .remedy = std::move(remedy)};
}

struct CloseFolder {
  void operator()(DIR* folder) const { ::closedir(folder); }
};

/// The names in a folder, sorted. Takes the descriptor.
std::vector<std::string> namesIn(hal::FileDescriptor folder) {
  std::vector<std::string> names;
  const std::unique_ptr<DIR, CloseFolder> stream(::fdopendir(folder.get()));
  if (!stream) return names;
  folder.release();  // it is the stream's now
  while (const dirent* each = ::readdir(stream.get())) {
    const std::string_view name = static_cast<const char*>(each->d_name);
    if (!isLeftOut(name)) names.emplace_back(name);
  }
  std::ranges::sort(names);
  return names;
}

class BundleReader {
 public:
  explicit BundleReader(const BundleLimits& limits) : limits_(limits) {}

  hal::Result<void> readFolder(int at, const std::string& name, const std::string& path,
                               int depth) {
    hal::FileDescriptor folder(
        ::openat(at, name.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    if (!folder) return tl::unexpected(cannotOpen(path.empty() ? name : path, errno));
    if (depth > limits_.depth) {
      return tl::unexpected(invalid(path, "lies too deep in folders",
                                    fmt::format("use at most {} of them", limits_.depth)));
    }
    for (const std::string& each : namesIn(hal::FileDescriptor(::dup(folder.get())))) {
      const std::string within = path.empty() ? each : path + "/" + each;
      if (auto read = readEntry(folder.get(), each, within, depth); !read) return read;
    }
    return {};
  }

  Bundle take() { return std::move(bundle_); }

 private:
  static hal::Error cannotOpen(const std::string& path, int error) {
    if (error == ELOOP) {
      return invalid(path, "is a symbolic link", "put the file itself in its place");
    }
    return hal::errnoError(path, "cannot be opened", error);
  }

  hal::Result<void> readEntry(int folder, const std::string& name, const std::string& path,
                              int depth) {
    // A pipe or a device must neither wait nor do anything when it is opened.
    hal::FileDescriptor file(
        ::openat(folder, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
    if (!file) return tl::unexpected(cannotOpen(path, errno));
    struct stat state {};
    if (::fstat(file.get(), &state) != 0) return tl::unexpected(cannotOpen(path, errno));
    if (S_ISDIR(state.st_mode)) return readFolder(folder, name, path, depth + 1);
    if (!S_ISREG(state.st_mode)) {
      return tl::unexpected(invalid(path, "is no ordinary file", "remove it"));
    }
    if (bundle_.files.size() == limits_.files) {
      return tl::unexpected(invalid(path, fmt::format("is more than {} files", limits_.files),
                                    "keep only site.toml and what it names"));
    }
    return readFile(file.get(), path);
  }

  hal::Result<void> readFile(int file, const std::string& path) {
    std::string content;
    std::array<char, 65536> part{};
    for (;;) {
      const ssize_t size = ::read(file, part.data(), part.size());
      if (size < 0 && errno == EINTR) continue;
      if (size < 0) return tl::unexpected(hal::errnoError(path, "cannot be read", errno));
      if (size == 0) break;
      content.append(part.data(), static_cast<std::size_t>(size));
      bytes_ += static_cast<std::size_t>(size);
      if (bytes_ > limits_.bytes) {
        return tl::unexpected(invalid(
            path, fmt::format("is too large: all files have more than {} MiB", limits_.bytes >> 20),
            "keep only site.toml and what it names"));
      }
    }
    // FAT knows no case.
    const bool isSite = lowered(path) == kSiteName;
    bundle_.files[isSite ? std::string(kSiteName) : path] = std::move(content);
    return {};
  }

  BundleLimits limits_;
  Bundle bundle_;
  std::size_t bytes_ = 0;
};

/// Why a site file of such bytes cannot be TOML, told better than its parser can.
hal::Result<void> checkEncoding(const std::string& text) {
  const auto begins = [&](std::string_view bytes) { return text.starts_with(bytes); };
  const bool isWide = begins("\xFF\xFE") || begins("\xFE\xFF");
  if (!isWide && config::tomlString(text)) return {};
  return tl::unexpected(invalid(std::string(kSiteName),
                                isWide ? "is encoded in UTF-16" : "is not encoded in UTF-8",
                                "save it as UTF-8"));
}

}  // namespace

bool hasSite(const fs::path& folder) {
  hal::FileDescriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!opened) return errno != ENOENT && errno != ENOTDIR;  // there is one, that cannot be read
  return std::ranges::any_of(namesIn(std::move(opened)), [](const std::string& name) {
    return lowered(name) == kSiteName || lowered(name) == kHiddenEnding;
  });
}

hal::Result<Bundle> readBundle(const fs::path& folder, const BundleLimits& limits) {
  BundleReader reader(limits);
  // The folder itself may be reached by a link: it is the administrator's word.
  std::error_code ignored;
  const fs::path real = fs::canonical(folder, ignored);
  if (auto read = reader.readFolder(AT_FDCWD, (real.empty() ? folder : real).string(), {}, 0);
      !read) {
    return tl::unexpected(std::move(read.error()));
  }
  Bundle bundle = reader.take();
  const auto site = bundle.files.find(std::string(kSiteName));
  if (site != bundle.files.end()) {
    if (auto checked = checkEncoding(site->second); !checked) {
      return tl::unexpected(std::move(checked.error()));
    }
    return bundle;
  }
  for (const auto& [name, content] : bundle.files) {
    if (lowered(name) != kHiddenEnding) continue;
    return tl::unexpected(
        invalid(name, "has a second ending", "rename it site.toml, with endings of files shown"));
  }
  return tl::unexpected(invalid(std::string(kSiteName), "is not there", "write it"));
}

std::string digestOf(const Bundle& bundle) {
  digest::Sha256Stream stream;
  for (const auto& [path, content] : bundle.files) {
    stream.add(fmt::format("{} {} {}\n", path.size(), content.size(), path));
    stream.add(content);
  }
  return digest::hexOf(stream.finish());
}

std::string fingerprintOf(const fs::path& folder) {
  constexpr std::size_t kMost = 1024;
  if (!hasSite(folder)) return {};
  std::vector<std::string> lines;
  std::error_code failure;
  for (fs::recursive_directory_iterator each(folder, failure), end; !failure && each != end;
       each.increment(failure)) {
    if (lines.size() == kMost) break;
    struct stat state {};
    if (::lstat(each->path().c_str(), &state) != 0) continue;
    lines.push_back(fmt::format("{} {} {}.{}", each->path().string(), state.st_size,
                                state.st_mtim.tv_sec, state.st_mtim.tv_nsec));
  }
  std::ranges::sort(lines);
  std::string all = folder.string() + "\n";
  for (const std::string& line : lines) all += line + "\n";
  return all;
}

}  // namespace pleinair::app
