#include "pipeline/record/zip_file.h"

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include <archive.h>
#include <archive_entry.h>

#include "hal/pending_file.h"

namespace pleinair::record {

struct ArchiveRelease {
  void operator()(archive* each) const { archive_write_free(each); }
};
struct EntryRelease {
  void operator()(archive_entry* each) const { archive_entry_free(each); }
};

struct ZipFile::State {
  State(std::filesystem::path pathOf, hal::PendingFile fileOf)
      : path(std::move(pathOf)), file(std::move(fileOf)), zip(archive_write_new()) {}

  /// Called by libarchive with each piece of the archive.
  static la_ssize_t write(archive*, void* self, const void* bytes, std::size_t size) {
    State& state = *static_cast<State*>(self);
    auto written = state.file.write({static_cast<const std::uint8_t*>(bytes), size});
    if (written) return static_cast<la_ssize_t>(size);
    if (!state.failure) state.failure = std::move(written.error());
    return -1;
  }

  hal::Error fault() const {
    if (failure) return *failure;
    const char* text = archive_error_string(zip.get());
    return {.kind = hal::ErrorKind::kIo,
            .subject = path.string(),
            .problem = text == nullptr ? "cannot write" : text,
            .remedy = {}};
  }

  std::filesystem::path path;
  hal::PendingFile file;
  std::optional<hal::Error> failure;             ///< of the file
  std::unique_ptr<archive, ArchiveRelease> zip;  ///< last: it writes when it is freed
};

ZipFile::ZipFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
ZipFile::ZipFile(ZipFile&&) noexcept = default;
ZipFile& ZipFile::operator=(ZipFile&&) noexcept = default;
ZipFile::~ZipFile() = default;

hal::Result<ZipFile> ZipFile::create(const std::filesystem::path& path) {
  auto file = hal::PendingFile::create(path);
  if (!file) return tl::unexpected(std::move(file.error()));
  auto state = std::make_unique<State>(path, *std::move(file));
  archive* zip = state->zip.get();
  archive_write_set_format_zip(zip);
  archive_write_set_bytes_per_block(zip, 0);  // no padding
  if (archive_write_open2(zip, state.get(), nullptr, &State::write, nullptr, nullptr) !=
      ARCHIVE_OK) {
    return tl::unexpected(state->fault());
  }
  return ZipFile(std::move(state));
}

hal::Result<void> ZipFile::add(const std::string& name, std::string_view content,
                               WallTime modified) {
  constexpr int kPermissions = 0644;
  archive* zip = state_->zip.get();
  const bool isPicture = name.ends_with(".png") || name.ends_with(".jpg");
  if (isPicture) {
    archive_write_zip_set_compression_store(zip);
  } else {
    archive_write_zip_set_compression_deflate(zip);
  }
  const std::unique_ptr<archive_entry, EntryRelease> entry(archive_entry_new());
  const auto time = std::chrono::floor<std::chrono::seconds>(modified);
  archive_entry_set_pathname(entry.get(), name.c_str());
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_perm(entry.get(), kPermissions);
  archive_entry_set_size(entry.get(), static_cast<la_int64_t>(content.size()));
  archive_entry_set_mtime(entry.get(), time.time_since_epoch().count(), 0);
  if (archive_write_header(zip, entry.get()) < ARCHIVE_WARN) {
    return tl::unexpected(state_->fault());
  }
  if (!content.empty() && archive_write_data(zip, content.data(), content.size()) !=
                              static_cast<la_ssize_t>(content.size())) {
    return tl::unexpected(state_->fault());
  }
  if (archive_write_finish_entry(zip) != ARCHIVE_OK) return tl::unexpected(state_->fault());
  return {};
}

hal::Result<void> ZipFile::publish() {
  if (archive_write_close(state_->zip.get()) != ARCHIVE_OK) {
    return tl::unexpected(state_->fault());
  }
  return state_->file.publish();
}

}  // namespace pleinair::record
