#include "hal/outputs/movie/movie_output.h"

#include <cassert>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <unistd.h>

#include "hal/outputs/movie/movie_name.h"
#include "hal/outputs/movie/movie_writer.h"
#include "hal/outputs/movie/sound_encoder.h"
#include "hal/outputs/movie/sound_track.h"

namespace pleinair::hal {
namespace {

class MovieOutput final : public MemoryOutput {
 public:
  MovieOutput(std::filesystem::path path, MovieOptions options, FileSystem& files)
      : path_(std::move(path)), options_(std::move(options)), files_(files) {}

  OutputIdentity identity() const override { return {.backend = "movie", .id = path_.string()}; }

  Result<OutputFormat> start(const OutputRequest& request) override;

  Result<void> write(const ImageView& picture, Duration time) override {
    assert(writer_ != nullptr && picture.format == format_.frame && picture.isComplete());
    return writer_->write(picture, time);
  }

  Result<void> finish() override {
    assert(writer_ != nullptr);
    Result<void> finished = writer_->finish();
    if (!finished) return finished;
    return file_->publish();
  }

 private:
  Result<std::unique_ptr<movie::MovieWriter>> openWriter(movie::FileKind kind);
  Result<std::unique_ptr<movie::SoundSource>> openSound(std::optional<movie::Container> container);

  std::filesystem::path path_;
  MovieOptions options_;
  FileSystem& files_;
  movie::MovieFormat format_{};
  std::optional<PendingFile> file_;
  std::unique_ptr<movie::MovieWriter> writer_;  ///< writes to file_
};

Result<movie::MovieFormat> formatFor(const OutputRequest& request, const std::string& subject) {
  if (!isAcceptedSize(request.size)) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = subject,
                                .problem = "cannot take this size",
                                .remedy = "use 1 to 8192 px a side and at most 64 Mpx"});
  }
  constexpr int kFirstHdLine = 720;
  constexpr Duration kDefaultPeriod = Duration(std::chrono::seconds(1)) / 30;
  const ColorMatrix matrix =
      request.size.height >= kFirstHdLine ? ColorMatrix::kBt709 : ColorMatrix::kBt601;
  const Duration period = request.framePeriod.value_or(kDefaultPeriod);
  return movie::MovieFormat{
      .frame = {.pixelFormat = PixelFormat::kI420,
                .size = request.size,
                .encoding = {.matrix = matrix, .range = ColorRange::kLimited}},
      .framePeriod = period > Duration::zero() ? period : kDefaultPeriod};
}

Result<OutputFormat> MovieOutput::start(const OutputRequest& request) {
  assert(!file_);
  const std::optional<movie::FileKind> kind = movie::fileKindOf(path_);
  if (!kind) {
    return tl::unexpected(Error{.kind = ErrorKind::kInvalidArgument,
                                .subject = path_.string(),
                                .problem = "is not the name of a movie that can be written",
                                .remedy = "end it in .mp4, .mkv or .y4m"});
  }
  const auto format = formatFor(request, path_.string());
  if (!format) return tl::unexpected(format.error());
  format_ = *format;
  format_.codec = options_.codec;
  format_.crf = options_.crf;
  if (options_.codec == VideoCodec::kFfv1 && *kind == movie::FileKind::kMp4) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = path_.string(),
                                .problem = "cannot hold FFV1",
                                .remedy = "end its name in .mkv"});
  }
  Result<PendingFile> file = PendingFile::create(path_, files_);
  if (!file) return tl::unexpected(file.error());
  file_.emplace(*std::move(file));
  auto writer = openWriter(*kind);
  if (!writer) return tl::unexpected(writer.error());
  writer_ = *std::move(writer);
  return OutputFormat{.frame = format_.frame, .refresh = std::nullopt};
}

Result<std::unique_ptr<movie::MovieWriter>> MovieOutput::openWriter(movie::FileKind kind) {
  if (kind == movie::FileKind::kY4m) {
    if (auto sound = openSound(std::nullopt); !sound) return tl::unexpected(sound.error());
    return movie::openY4mWriter(
        format_, [this](std::span<const std::uint8_t> bytes) { return file_->write(bytes); });
  }
  const auto container =
      kind == movie::FileKind::kMp4 ? movie::Container::kMp4 : movie::Container::kMkv;
  auto sound = openSound(container);
  if (!sound) return tl::unexpected(sound.error());
  return movie::openCodedWriter(container, format_, path_.string(), *file_, *std::move(sound));
}

/// Null where there is none, or where the file holds none, of which a notice tells.
Result<std::unique_ptr<movie::SoundSource>> MovieOutput::openSound(
    std::optional<movie::Container> container) {
  if (!options_.soundOf) return nullptr;
  auto track = movie::SoundTrack::open(*options_.soundOf, options_.soundFrom);
  if (!track) return tl::unexpected(track.error());
  if (*track == nullptr) return nullptr;
  const std::string coding = avcodec_get_name((*track)->coding().codec_id);
  const auto notify = [this](const std::string& notice) {
    if (options_.onNotice) options_.onNotice(path_.string() + ": " + notice);
  };
  if (!container) {
    notify("holds no sound: that of the recording is left out; an .mkv would hold it");
    return nullptr;
  }
  if (movie::canHold(*container, (*track)->coding())) return track;
  if (auto recoded = movie::recodeSound(*std::move(track))) {
    notify("holds no sound coded as " + coding + ", which becomes AAC; an .mkv would keep it");
    return recoded;
  }
  notify("holds no sound coded as " + coding + ", which is left out; an .mkv would hold it");
  return nullptr;
}

/// Y4M to standard output.
class MovieStream final : public MemoryOutput {
 public:
  OutputIdentity identity() const override { return {.backend = "movie", .id = "-"}; }

  Result<OutputFormat> start(const OutputRequest& request) override {
    const auto format = formatFor(request, kStandardOutput);
    if (!format) return tl::unexpected(format.error());
    auto writer = movie::openY4mWriter(*format, &MovieStream::writeAll);
    if (!writer) return tl::unexpected(writer.error());
    writer_ = *std::move(writer);
    return OutputFormat{.frame = format->frame, .refresh = std::nullopt};
  }
  Result<void> write(const ImageView& picture, Duration time) override {
    return writer_->write(picture, time);
  }
  Result<void> finish() override { return writer_->finish(); }

 private:
  static constexpr const char* kStandardOutput = "standard output";

  static Result<void> writeAll(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return tl::unexpected(errnoError(kStandardOutput, "cannot write", errno));
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return {};
  }

  std::unique_ptr<movie::MovieWriter> writer_;
};

}  // namespace

std::unique_ptr<MemoryOutput> openMovieStream() {
  return std::make_unique<MovieStream>();
}

std::unique_ptr<MemoryOutput> openMovieOutput(std::filesystem::path path, MovieOptions options,
                                              FileSystem& files) {
  return std::make_unique<MovieOutput>(std::move(path), std::move(options), files);
}

}  // namespace pleinair::hal
