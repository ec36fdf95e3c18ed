#include <cstdlib>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/outputs/movie/movie_writer.h"

namespace pleinair::hal::movie {
namespace {

class Y4mWriter final : public MovieWriter {
 public:
  explicit Y4mWriter(ByteSink sink) : sink_(std::move(sink)) {}

  Result<void> write(const ImageView& picture, Duration) override {
    static constexpr std::string_view kFrame = "FRAME\n";
    buffer_.assign(kFrame.begin(), kFrame.end());
    for (int plane = 0; plane < planeCount(picture.format.pixelFormat); ++plane) {
      const int rows = planeRows(picture.format.pixelFormat, plane, picture.format.size.height);
      for (int y = 0; y < rows; ++y) {
        const auto row = picture.row(plane, y);
        buffer_.insert(buffer_.end(), row.begin(), row.end());
      }
    }
    return sink_(buffer_);
  }

  Result<void> finish() override { return {}; }

 private:
  ByteSink sink_;
  std::vector<std::uint8_t> buffer_;
};

/// The rate as Y4M writes it. Periods come as rounded nanoseconds: 33333333 is 30:1.
std::string rateText(Duration period) {
  constexpr std::int64_t kNanoseconds = 1'000'000'000;
  const std::int64_t ns = period.count();
  for (const std::int64_t unit : {std::int64_t{1}, std::int64_t{1001}}) {
    const std::int64_t rate = (unit * kNanoseconds + ns / 2) / ns;
    const bool same = rate > 0 && std::abs(unit * kNanoseconds / rate - ns) <= 1;
    if (same) return std::to_string(rate) + ":" + std::to_string(unit);
  }
  const std::int64_t common = std::gcd(kNanoseconds, ns);
  return std::to_string(kNanoseconds / common) + ":" + std::to_string(ns / common);
}

}  // namespace

Result<std::unique_ptr<MovieWriter>> openY4mWriter(const MovieFormat& format, ByteSink sink) {
  const std::string header = "YUV4MPEG2 W" + std::to_string(format.frame.size.width) + " H" +
                             std::to_string(format.frame.size.height) + " F" +
                             rateText(format.framePeriod) +
                             " Ip A1:1 C420mpeg2 XYSCSS=420MPEG2 XCOLORRANGE=LIMITED\n";
  const std::vector<std::uint8_t> bytes(header.begin(), header.end());
  if (Result<void> written = sink(bytes); !written) return tl::unexpected(written.error());
  return std::make_unique<Y4mWriter>(std::move(sink));
}

}  // namespace pleinair::hal::movie
