#include "hal/outputs/headless/headless_output.h"

#include <algorithm>
#include <cassert>
#include <span>
#include <string>

namespace pleinair::hal {
namespace {

constexpr std::uint64_t kOffsetBasis = 0xCBF29CE484222325u;
constexpr std::uint64_t kPrime = 0x100000001B3u;

std::uint64_t mix(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * kPrime;
  return hash ^ hash >> 32;  // carries the high bits down, which a 64-bit FNV step does not
}

std::uint64_t wordOf(std::span<const std::uint8_t> bytes) {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) word |= std::uint64_t{bytes[i]} << 8 * i;
  return word;
}

std::uint64_t mixRow(std::uint64_t hash, std::span<const std::uint8_t> row) {
  constexpr std::size_t kWord = sizeof(std::uint64_t);
  for (; row.size() >= kWord; row = row.subspan(kWord)) hash = mix(hash, wordOf(row.first(kWord)));
  return row.empty() ? hash : mix(hash, wordOf(row));
}

}  // namespace

std::uint64_t hashOf(const ImageView& picture) {
  const FrameFormat& format = picture.format;
  std::uint64_t hash = kOffsetBasis;
  for (const int value :
       {static_cast<int>(format.pixelFormat), format.size.width, format.size.height,
        static_cast<int>(format.encoding.matrix), static_cast<int>(format.encoding.range)}) {
    hash = mix(hash, static_cast<std::uint64_t>(value));
  }
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    for (int y = 0; y < planeRows(format.pixelFormat, plane, format.size.height); ++y) {
      hash = mixRow(hash, picture.row(plane, y));
    }
  }
  return hash;
}

HeadlessOutput::HeadlessOutput(PixelFormat format, ColorEncoding encoding, Keeps keeps)
    : format_{.pixelFormat = format, .size = {}, .encoding = encoding},
      keeps_(keeps),
      running_(kOffsetBasis) {}

OutputIdentity HeadlessOutput::identity() const {
  return {.backend = "headless", .id = "headless"};
}

Result<OutputFormat> HeadlessOutput::start(const OutputRequest& request) {
  if (!isAcceptedSize(request.size)) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = "headless",
                                .problem = "cannot take this size",
                                .remedy = "use 1 to 8192 px a side and at most 64 Mpx"});
  }
  format_.size = request.size;
  return OutputFormat{.frame = format_, .refresh = std::nullopt};
}

Result<void> HeadlessOutput::write(const ImageView& picture, Duration time) {
  assert(picture.format == format_ && picture.isComplete());
  if (keeps_ == Keeps::kNothing) return {};
  hashes_.push_back(hashOf(picture));
  times_.push_back(time);
  running_ = mix(running_, hashes_.back());
  return {};
}

Result<void> HeadlessOutput::finish() {
  return {};
}

OutputKind headlessKind() {
  return {
      .name = "headless",
      .help = "nothing is shown or written: to measure, and to run with the status server alone",
      .forms = {"headless"},
      .traits = {.isPaced = true},
      .options = {},
      .recognizes = [](const std::string& target) { return target == "headless"; },
      .list = [] { return OutputListing{.outputs = {{.target = "headless"}}, .problem = {}}; },
      .problemOf = nullptr,
      .make = [](const std::string&, const OutputOptions&) -> Result<std::unique_ptr<Output>> {
        return std::make_unique<HeadlessOutput>(PixelFormat::kRgb8, ColorEncoding{},
                                                HeadlessOutput::Keeps::kNothing);
      }};
}

}  // namespace pleinair::hal
