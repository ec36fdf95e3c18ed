#include "firmware_app/provisioning/kept_site.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <span>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "hal/file_descriptor.h"
#include "hal/pending_file.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPointer = "provisioned";
constexpr std::string_view kCopies = "provisioned.";
constexpr std::size_t kDigestDigits = 64;
constexpr std::size_t kNameDigits = 16;

hal::Error cannotKeep(const fs::path& place, const std::error_code& failure) {
  return hal::errnoError(place.string(), "cannot be made", failure.value());
}

/// Names in a folder reach the disk with the folder.
void syncFolder(const fs::path& folder) {
  const hal::FileDescriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened) ::fsync(opened.get());
}

hal::Result<void> writeFile(const fs::path& path, std::string_view content) {
  auto file = hal::PendingFile::create(path);
  if (!file) return tl::unexpected(std::move(file.error()));
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(content.data()),
                                            content.size());
  if (auto written = file->write(bytes); !written) return written;
  return file->publish();
}

bool holds(const fs::path& folder, const std::string& digest) {
  const hal::Result<Bundle> bundle = readBundle(folder);
  return bundle && digestOf(*bundle) == digest;
}

hal::Result<void> makeFolder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) return tl::unexpected(cannotKeep(folder, failure));
  return {};
}

}  // namespace

fs::path KeptSite::pointer() const {
  return state_ / kPointer;
}

fs::path KeptSite::folderOf(const std::string& digest) const {
  return state_ / (std::string(kCopies) + digest.substr(0, kNameDigits));
}

std::optional<KeptSite::Copy> KeptSite::inForce() const {
  if (state_.empty()) return std::nullopt;
  std::string digest(kDigestDigits, '\0');
  std::ifstream file(pointer());
  file.read(digest.data(), static_cast<std::streamsize>(digest.size()));
  const bool isDigest =
      file && std::ranges::all_of(digest, [](unsigned char c) { return std::isxdigit(c) != 0; });
  if (!isDigest) return std::nullopt;
  Copy copy{.digest = digest, .folder = folderOf(digest)};
  if (!holds(copy.folder, digest)) return std::nullopt;
  return copy;
}

hal::Result<KeptSite::Copy> KeptSite::write(const Bundle& bundle) const {
  if (state_.empty()) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kNotFound,
                                     .subject = std::string(kSiteName),
                                     .problem = "cannot be kept: there is no state folder",
                                     .remedy = "set STATE_DIRECTORY"});
  }
  Copy copy{.digest = digestOf(bundle), .folder = {}};
  copy.folder = folderOf(copy.digest);
  // It may be the one in force, which must not go for a moment.
  if (holds(copy.folder, copy.digest)) return copy;
  discard(copy);  // a part, of a run that ended while it wrote
  for (const auto& [path, content] : bundle.files) {
    const fs::path file = copy.folder / path;
    hal::Result<void> written = makeFolder(file.parent_path());
    if (written) written = writeFile(file, content);
    if (!written) {
      discard(copy);
      return tl::unexpected(std::move(written.error()));
    }
    syncFolder(file.parent_path());
  }
  syncFolder(copy.folder);
  syncFolder(state_);
  return copy;
}

hal::Result<void> KeptSite::putInForce(const Copy& copy) const {
  if (auto written = writeFile(pointer(), copy.digest + "\n"); !written) return written;
  syncFolder(state_);
  removeAllBut(copy.folder);
  return {};
}

void KeptSite::discard(const Copy& copy) const {
  std::error_code ignored;
  fs::remove_all(copy.folder, ignored);
}

void KeptSite::removeAllBut(const fs::path& kept) const {
  std::vector<fs::path> others;
  std::error_code failure;
  for (fs::directory_iterator each(state_, failure), end; !failure && each != end;
       each.increment(failure)) {
    const bool isCopy = each->path().filename().string().starts_with(kCopies);
    if (isCopy && each->path() != kept) others.push_back(each->path());
  }
  for (const fs::path& other : others) {
    std::error_code ignored;
    fs::remove_all(other, ignored);
  }
}

}  // namespace pleinair::app
