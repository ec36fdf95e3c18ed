// A painter that draws straight into the textures of a window, under a stepped clock: the trial
// that decides on it, and what goes wrong.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include "hal/file_descriptor.h"
#include "pipeline/runtime/live_pipeline.h"
#include "tests/support/live_simulation.h"

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;
using support::SimulatedGpu;
using testing::HasSubstr;

constexpr hal::FrameSize kWindowSize{64, 48};

/// The desktop, which outlives windows.
struct Desktop {
  int display = 0;          ///< its address stands for the EGLDisplay
  bool sharesNone = false;  ///< the driver
  bool isGone = false;      ///< the display server
  bool garblesTextures = false;
  std::vector<std::uint32_t> shown;  ///< first pixel of each picture, 0x00RRGGBB
  int windows = 0;
  int endings = 0;  ///< of lending
};

/// A memory output that lends textures, whose memory stands behind descriptors here.
class TexturedWindow final : public hal::MemoryOutput, public hal::GpuSurfaceLender {
 public:
  explicit TexturedWindow(Desktop& desktop) : desktop_(desktop) { ++desktop_.windows; }
  ~TexturedWindow() override { --desktop_.windows; }
  TexturedWindow(const TexturedWindow&) = delete;
  TexturedWindow& operator=(const TexturedWindow&) = delete;

  hal::OutputIdentity identity() const override { return {"window", "window"}; }
  hal::Result<hal::OutputFormat> start(const hal::OutputRequest& request) override {
    size_ = request.size;
    return hal::OutputFormat{
        .frame = {.pixelFormat = hal::PixelFormat::kRgba8, .size = size_, .encoding = {}},
        .refresh = hal::Refresh{.period = 16667us, .phase = {}}};
  }
  hal::Result<hal::OutputFormat> reconfigure(const hal::OutputRequest& request) override {
    textures_.clear();
    seen_.reset();
    return start(request);
  }
  hal::Result<void> write(const hal::ImageView& picture, hal::Duration) override {
    if (desktop_.isGone) return tl::unexpected(gone());
    replace(std::nullopt);
    const auto row = picture.row(0, 0);
    desktop_.shown.push_back(std::uint32_t{row[0]} << 16U | std::uint32_t{row[1]} << 8U | row[2]);
    return {};
  }
  hal::Result<void> finish() override { return {}; }

  hal::GpuSurfaceLender* lender() override { return this; }
  hal::Result<void*> eglDisplay() override {
    if (!desktop_.sharesNone) return &desktop_.display;
    return tl::unexpected(refusal("is drawn by software"));
  }
  hal::Result<std::vector<hal::GpuSurface>> lendToGpu(std::span<const std::uint64_t>,
                                                      std::size_t count) override {
    if (desktop_.isGone) return tl::unexpected(gone());
    textures_.clear();
    seen_.reset();
    std::vector<hal::GpuSurface> lent;
    for (std::size_t i = 0; i < count; ++i) {
      Texture texture{.memory = hal::FileDescriptor(memfd_create("texture", 0))};
      EXPECT_EQ(ftruncate(texture.memory.get(), static_cast<long>(bytes())), 0);
      hal::GpuSurface surface{.surface = {}, .bufferSize = size_};
      surface.surface.id = hal::SurfaceId{static_cast<std::uint32_t>(i)};
      surface.surface.format = {
          .pixelFormat = hal::PixelFormat::kRgba8, .size = size_, .encoding = {}};
      surface.surface.planes[0] = {.dmaBuf = texture.memory.get(),
                                   .offsetBytes = 0,
                                   .strideBytes = std::size_t{4} * std::size_t(size_.width)};
      lent.push_back(surface);
      textures_.push_back(std::move(texture));
    }
    return lent;
  }
  void endLending() override { ++desktop_.endings; }
  hal::Result<std::optional<hal::SurfaceId>> acquireForGpu() override {
    if (desktop_.isGone) return tl::unexpected(gone());
    for (std::size_t i = 0; i < textures_.size(); ++i) {
      if (std::exchange(textures_[i].isTaken, true)) continue;
      return hal::SurfaceId{static_cast<std::uint32_t>(i)};
    }
    return std::nullopt;
  }
  hal::Result<hal::Image> copyOfGpuSurface(hal::SurfaceId id, bool isWholeBuffer) override {
    if (!isWholeBuffer && seen_ != id) return tl::unexpected(refusal("has another by now"));
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = size_, .encoding = {}});
    const std::vector<std::uint8_t> memory = read(id);
    for (std::size_t i = 0; i < memory.size(); i += 4) {
      for (std::size_t c = 0; c < 3; ++c) image.plane(0)[i + c] = memory[i + 2 - c];
      if (desktop_.garblesTextures) image.plane(0)[i] ^= 1;
    }
    return image;
  }
  hal::Result<void> show(hal::SurfaceId id, hal::Duration) override {
    if (desktop_.isGone) return tl::unexpected(gone());
    EXPECT_TRUE(textures_.at(static_cast<std::size_t>(id)).isTaken);
    replace(id);
    std::uint32_t pixel = 0;
    std::memcpy(&pixel, read(id).data(), sizeof(pixel));
    desktop_.shown.push_back(pixel);
    return {};
  }

 private:
  struct Texture {
    hal::FileDescriptor memory;
    bool isTaken = false;
  };
  std::size_t bytes() const {
    return std::size_t{4} * static_cast<std::size_t>(size_.width * size_.height);
  }
  std::vector<std::uint8_t> read(hal::SurfaceId id) const {
    std::vector<std::uint8_t> memory(bytes());
    const int file = textures_.at(static_cast<std::size_t>(id)).memory.get();
    EXPECT_EQ(pread(file, memory.data(), memory.size(), 0), static_cast<long>(memory.size()));
    return memory;
  }
  void replace(std::optional<hal::SurfaceId> next) {
    if (seen_) textures_.at(static_cast<std::size_t>(*seen_)).isTaken = false;
    seen_ = next;
  }
  static hal::Error refusal(std::string problem) {
    return {.kind = hal::ErrorKind::kUnsupported,
            .subject = "window",
            .problem = std::move(problem),
            .remedy = {}};
  }
  static hal::Error gone() {
    return {.kind = hal::ErrorKind::kDeviceLost,
            .subject = "window",
            .problem = "the display server is gone",
            .remedy = {}};
  }

  Desktop& desktop_;
  hal::FrameSize size_;
  std::vector<Texture> textures_;
  std::optional<hal::SurfaceId> seen_;
};

class WindowTextures : public testing::Test {
 protected:
  WindowTextures()
      : selector_(support::selectorOf(
            [this](hal::Clock& clock) {
              return std::make_unique<support::PacedCamera>(camera_, clock);
            },
            live_.clock)) {
    live_.gpu.eglDisplay = &desktop_.display;
  }

  void begin() {
    live_.begin(selector_);
    OutputStageOptions options{.name = "window", .waiting = 16};
    options.keepsLastFrame = true;
    options.request = {.size = kWindowSize, .framePeriod = camera_.period};
    auto window = std::make_unique<TexturedWindow>(desktop_);
    const auto format = *window->start(options.request);
    stage_ = &live_.chain->addOutput(std::move(window), format, std::move(options));
    live_.start();
  }
  ScanOut scanOut() const { return stage_->status().scanOut; }
  long directSince(std::size_t from) const {
    return std::count_if(desktop_.shown.begin() + static_cast<long>(from), desktop_.shown.end(),
                         [](std::uint32_t pixel) { return pixel >= SimulatedGpu::kDrawn; });
  }
  void expectOnlyCopies(const std::string& reason) {
    const std::size_t before = desktop_.shown.size();
    live_.runFor(1s);
    EXPECT_GT(desktop_.shown.size(), before + 20);
    EXPECT_EQ(directSince(before), 0);
    EXPECT_EQ(scanOut().path, ScanOut::Path::kCopied);
    EXPECT_THAT(scanOut().reason, HasSubstr(reason));
    EXPECT_EQ(stage_->status().failures, 0u);
  }
  void expectSumsToAgree() {
    EXPECT_TRUE(live_.chain->ledger().counts().addsUp());
    for (const auto& output : live_.chain->status().outputs) EXPECT_TRUE(output.addsUp());
  }

  Desktop desktop_;
  support::LiveSimulation live_;
  support::PacedCameraOptions camera_;
  hal::CameraSelector selector_;
  OutputStage* stage_ = nullptr;
};

TEST_F(WindowTextures, ShowEveryFrameWithoutACopy) {
  begin();
  live_.runFor(1s);
  EXPECT_EQ(scanOut().path, ScanOut::Path::kDirect) << scanOut().reason;
  const std::size_t before = desktop_.shown.size();
  live_.runFor(10s);
  const std::size_t shown = desktop_.shown.size() - before;
  EXPECT_GE(shown, 299u);
  EXPECT_EQ(directSince(before), static_cast<long>(shown));
  for (std::size_t i = before + 1; i < desktop_.shown.size(); ++i) {
    ASSERT_EQ(desktop_.shown[i], desktop_.shown[i - 1] + 1) << "out of order";
  }
  EXPECT_EQ(scanOut().direct, static_cast<std::uint64_t>(directSince(0)));
  expectSumsToAgree();
}

TEST_F(WindowTextures, AreNotUsedWhereTheWindowSharesNone) {
  desktop_.sharesNone = true;
  begin();
  expectOnlyCopies("is drawn by software");
}

TEST_F(WindowTextures, AreNotUsedWhereThePainterIsOnAnotherDisplay) {
  int other = 0;
  live_.gpu.eglDisplay = &other;
  live_.gpu.drawable = {hal::kLinearModifier};  // which is for displays
  live_.gpu.apartBecause = "paintings are made by one, the window by another";
  begin();
  expectOnlyCopies("paintings are made by one, the window by another");
  EXPECT_EQ(live_.gpu.imports, 0);
}

TEST_F(WindowTextures, AreNotUsedWhereTheImportIsRefused) {
  live_.gpu.importError = hal::Error{.kind = hal::ErrorKind::kUnsupported,
                                     .subject = "GPU",
                                     .problem = "makes no texture of it",
                                     .remedy = {}};
  begin();
  expectOnlyCopies("makes no texture of it");
}

TEST_F(WindowTextures, AreNotUsedWhereThePatternArrivesWrong) {
  desktop_.garblesTextures = true;
  begin();
  expectOnlyCopies("arrives wrong");
  EXPECT_EQ(desktop_.endings, 1) << "its memory is freed";
}

TEST_F(WindowTextures, AServerThatDiesIsALossOfTheWindowAlone) {
  begin();
  live_.runFor(1s);
  ASSERT_EQ(scanOut().path, ScanOut::Path::kDirect);
  const std::size_t noted = live_.notes.size();
  desktop_.isGone = true;
  live_.runFor(1s);
  EXPECT_TRUE(stage_->status().isFinal);
  EXPECT_EQ(stage_->status().failures, 1u);
  EXPECT_GE(live_.notes.size(), noted + 29) << "the other output goes on";
  EXPECT_EQ(live_.chain->status().painting.contextLosses, 0u);
  expectSumsToAgree();
}

TEST_F(WindowTextures, GoOnWithTheGpuThatCameBack) {
  int losses = 2;
  live_.gpu.isLostAt = [&](std::uint64_t sequence) { return sequence % 50 == 49 && losses-- > 0; };
  begin();
  live_.runFor(8s);
  EXPECT_EQ(live_.gpu.imports, 3);
  EXPECT_EQ(scanOut().path, ScanOut::Path::kDirect) << scanOut().reason;
  const std::size_t before = desktop_.shown.size();
  live_.runFor(1s);
  EXPECT_GE(directSince(before), 29);
  expectSumsToAgree();
}

TEST_F(WindowTextures, FollowAnotherStream) {
  begin();
  live_.runFor(1s);
  stage_->reconfigure({.size = {40, 48}, .framePeriod = camera_.period});
  live_.runFor(2s);
  EXPECT_EQ(scanOut().path, ScanOut::Path::kDirect) << scanOut().reason;
  const std::size_t before = desktop_.shown.size();
  live_.runFor(1s);
  EXPECT_GE(directSince(before), 29);
  expectSumsToAgree();
}

TEST_F(WindowTextures, TheLastFrameIsReadOnTheWindowsThread) {
  begin();
  live_.runFor(1s);
  ASSERT_EQ(scanOut().path, ScanOut::Path::kDirect);
  stage_->refreshLastFrame();
  std::optional<hal::Image> last = stage_->lastFrame();
  ASSERT_TRUE(last.has_value());
  const std::uint32_t shown = desktop_.shown.back();
  EXPECT_EQ(last->row(0, 3)[8], (shown >> 16U) & 255U);
  EXPECT_EQ(last->row(0, 3)[10], shown & 255U);
}

TEST_F(WindowTextures, FramesThatAppearOverAPictureAreCopied) {
  begin();
  live_.runFor(1s);
  const std::size_t before = desktop_.shown.size();
  live_.gpu.cost = [](std::uint64_t, std::size_t) { return hal::Duration(400ms); };
  stage_->showWaiting(std::make_shared<const hal::Image>(stage_->format().frame));
  live_.runFor(2s);
  live_.gpu.cost = [](std::uint64_t, std::size_t) { return hal::Duration(10ms); };
  live_.runFor(3s);
  const std::size_t after = desktop_.shown.size();
  EXPECT_GT(static_cast<long>(after - before), directSince(before)) << "some were blended";
  live_.runFor(1s);
  EXPECT_EQ(directSince(after), static_cast<long>(desktop_.shown.size() - after));
  expectSumsToAgree();
}

}  // namespace
}  // namespace pleinair::runtime
