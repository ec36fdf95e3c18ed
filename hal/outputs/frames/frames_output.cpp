#include "hal/outputs/frames/frames_output.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "hal/numbered_path.h"

namespace pleinair::hal {
namespace {

/// Where pictures go.
class PictureSink {
 public:
  virtual ~PictureSink() = default;
  virtual Result<void> write(std::span<const std::uint8_t> bytes) = 0;
  virtual Result<void> finish() = 0;
};

/// Keeps other writers away from the names of a pattern as long as it lives, by a partial file of
/// the pattern's name: "out/.%06d.png.part". What a killed writer left of these names is removed.
class PatternLock {
 public:
  static Result<PatternLock> take(const std::filesystem::path& pattern, const NumberedPath& names,
                                  FileSystem& files) {
    std::filesystem::path path = pattern;
    path.replace_filename("." + pattern.filename().string() + ".part");
    const int fd = files.create(path);
    if (fd == -EEXIST) {
      return tl::unexpected(Error{.kind = ErrorKind::kBusy,
                                  .subject = pattern.string(),
                                  .problem = "another run writes pictures of these names",
                                  .remedy = "wait for its end, or give another folder"});
    }
    if (fd < 0) return tl::unexpected(errnoError(path.string(), "cannot write", -fd));
    const std::filesystem::path folder = names.folder().empty() ? "." : names.folder();
    for (const std::filesystem::path& part : stalePartsIn(folder)) {
      if (names.numberOf(finalNameOf(part))) files.unlink(part);
    }
    return PatternLock(std::move(path), FileDescriptor(fd, files), files);
  }
  PatternLock(PatternLock&&) noexcept = default;
  PatternLock& operator=(PatternLock&&) = delete;
  PatternLock(const PatternLock&) = delete;
  PatternLock& operator=(const PatternLock&) = delete;
  ~PatternLock() {
    if (file_) files_->unlink(path_);  // before it is closed, which unlocks it
  }

 private:
  PatternLock(std::filesystem::path path, FileDescriptor file, FileSystem& files)
      : path_(std::move(path)), files_(&files), file_(std::move(file)) {}

  std::filesystem::path path_;
  FileSystem* files_;
  FileDescriptor file_;
};

class NumberedPictures final : public PictureSink {
 public:
  NumberedPictures(NumberedPath names, PatternLock lock, FileSystem& files)
      : names_(std::move(names)), lock_(std::move(lock)), files_(files) {}

  Result<void> write(std::span<const std::uint8_t> bytes) override {
    Result<PendingFile> file = PendingFile::create(names_.at(next_), files_);
    if (!file) return tl::unexpected(file.error());
    if (Result<void> written = file->write(bytes); !written) return written;
    ++next_;
    return file->publish(Durability::kUnsynced);  // one of many: the next is waiting
  }
  Result<void> finish() override { return {}; }

 private:
  NumberedPath names_;
  PatternLock lock_;
  FileSystem& files_;
  std::uint64_t next_ = 0;
};

class SinglePicture final : public PictureSink {
 public:
  SinglePicture(std::string subject, PendingFile file)
      : subject_(std::move(subject)), file_(std::move(file)) {}

  Result<void> write(std::span<const std::uint8_t> bytes) override {
    if (std::exchange(taken_, true)) {
      return tl::unexpected(Error{.kind = ErrorKind::kInvalidArgument,
                                  .subject = subject_,
                                  .problem = "holds one picture, and there are more",
                                  .remedy = "give a pattern such as out/%04d.png, or a folder"});
    }
    return file_.write(bytes);
  }

  Result<void> finish() override {
    if (!taken_) {
      return tl::unexpected(Error{.kind = ErrorKind::kInvalidInput,
                                  .subject = subject_,
                                  .problem = "there was no picture to write"});
    }
    return file_.publish();
  }

 private:
  std::string subject_;
  PendingFile file_;
  bool taken_ = false;
};

using SinkResult = Result<std::unique_ptr<PictureSink>>;

Result<void> makeFolder(const std::filesystem::path& folder) {
  std::error_code status;
  std::filesystem::create_directory(folder, status);
  if (!status) return {};
  return tl::unexpected(errnoError(folder.string(), "cannot create the folder", status.value(),
                                   "create its parent first, or choose another place"));
}

SinkResult numbered(const std::filesystem::path& pattern, FileSystem& files) {
  const Result<NumberedPath> names = NumberedPath::parse(pattern.string());
  if (!names) return tl::unexpected(names.error());
  std::error_code ignored;
  const std::filesystem::path folder = names->folder();
  if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
    return tl::unexpected(Error{.kind = ErrorKind::kNotFound,
                                .subject = folder.string(),
                                .problem = "no such folder",
                                .remedy = "create it first"});
  }
  Result<PatternLock> lock = PatternLock::take(pattern, *names, files);
  if (!lock) return tl::unexpected(lock.error());
  return std::make_unique<NumberedPictures>(*names, *std::move(lock), files);
}

SinkResult openSink(const std::filesystem::path& path, FileSystem& files) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored) || !path.has_filename() ||
      (!path.has_extension() && !looksNumbered(path))) {
    if (Result<void> made = makeFolder(path); !made) return tl::unexpected(made.error());
    return numbered(path / "%06d.png", files);
  }
  if (!writtenPictureKind(path)) {
    return tl::unexpected(
        Error{.kind = ErrorKind::kInvalidArgument,
              .subject = path.string(),
              .problem = "is not the name of pictures that can be written",
              .remedy = "end it in " + writtenPictureEndings() + ", or give a folder"});
  }
  if (looksNumbered(path)) return numbered(path, files);
  Result<PendingFile> file = PendingFile::create(path, files);
  if (!file) return tl::unexpected(file.error());
  return std::make_unique<SinglePicture>(path.string(), *std::move(file));
}

class FramesOutput final : public MemoryOutput {
 public:
  FramesOutput(std::filesystem::path path, const PictureFileOptions& options, FileSystem& files)
      : path_(std::move(path)), options_(options), files_(files) {}

  OutputIdentity identity() const override { return {.backend = "frames", .id = path_.string()}; }

  Result<OutputFormat> start(const OutputRequest& request) override {
    assert(sink_ == nullptr);
    if (!isAcceptedSize(request.size)) {
      return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                  .subject = path_.string(),
                                  .problem = "cannot take this size",
                                  .remedy = "use 1 to 8192 px a side and at most 64 Mpx"});
    }
    const FrameFormat format{
        .pixelFormat = PixelFormat::kRgb8, .size = request.size, .encoding = {}};
    // Of folders: PNG.
    const auto kind = writtenPictureKind(path_).value_or(PictureFileKind::kPng);
    Result<std::unique_ptr<PictureEncoder>> encoder = openPictureEncoder(kind, format, options_);
    if (!encoder) return tl::unexpected(encoder.error());
    encoder_ = *std::move(encoder);
    SinkResult sink = openSink(path_, files_);
    if (!sink) return tl::unexpected(sink.error());
    sink_ = *std::move(sink);
    return OutputFormat{.frame = format, .refresh = std::nullopt};
  }

  Result<void> write(const ImageView& picture, Duration) override {
    assert(sink_ != nullptr);
    const Result<std::vector<std::uint8_t>> bytes = encoder_->encode(picture);
    if (!bytes) return tl::unexpected(bytes.error());
    return sink_->write(*bytes);
  }

  Result<void> finish() override {
    assert(sink_ != nullptr);
    return sink_->finish();
  }

 private:
  std::filesystem::path path_;
  PictureFileOptions options_;
  FileSystem& files_;
  std::unique_ptr<PictureEncoder> encoder_;
  std::unique_ptr<PictureSink> sink_;
};

bool isFramesTarget(const std::string& target) {
  const std::filesystem::path path(target);
  std::error_code ignored;
  return !target.empty() && (std::filesystem::is_directory(path, ignored) || !path.has_filename() ||
                             !path.has_extension() || writtenPictureKind(path).has_value());
}

}  // namespace

OutputKind framesKind() {
  return {.name = "frames",
          .help = "pictures: one, numbered ones, or a folder of them",
          .forms = {"picture.png", "picture.jpg", "picture.tif", "out/%04d.png", "folder/"},
          .traits = {.writesFiles = true},
          .options = {},
          .recognizes = isFramesTarget,
          .list = nullptr,
          .problemOf = nullptr,
          .make = [](const std::string& target, const OutputOptions&)
              -> Result<std::unique_ptr<Output>> { return openFramesOutput(target); }};
}

std::unique_ptr<MemoryOutput> openFramesOutput(std::filesystem::path path, FileSystem& files) {
  return openFramesOutput(std::move(path), {}, files);
}

std::unique_ptr<MemoryOutput> openFramesOutput(std::filesystem::path path,
                                               const PictureFileOptions& options,
                                               FileSystem& files) {
  return std::make_unique<FramesOutput>(std::move(path), options, files);
}

}  // namespace pleinair::hal
