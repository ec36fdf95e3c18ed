#include "pipeline/gpu/frame_trial.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "hal/dma_buf_sync.h"
#include "pipeline/gpu/egl_context.h"
#include "pipeline/gpu/frame_planes.h"
#include "pipeline/gpu/frame_upload.h"
#include "pipeline/gpu/imported_texture.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/shader_library.h"

namespace pleinair::gpu {
namespace {

constexpr const char* kArgument = "--read-frame";
constexpr const char* kTask = "read the camera's memory";
constexpr std::size_t kFixed = 6;  ///< numbers that all frames have
constexpr std::size_t kPerPlane = 2;
// Exit statuses of the child.
constexpr int kFailed = 1;
constexpr int kBadArguments = 2;
constexpr int kOtherPixels = 3;
constexpr int kNoImport = 4;

/// A frame as arguments: layout, size, encoding, modifier; then offset and stride of each plane.
std::vector<std::string> argumentsOf(const hal::CapturedFrame& frame) {
  const hal::FrameFormat& format = frame.image.format;
  std::vector<std::string> arguments{"pleinair",
                                     kArgument,
                                     std::to_string(static_cast<int>(format.pixelFormat)),
                                     std::to_string(format.size.width),
                                     std::to_string(format.size.height),
                                     std::to_string(static_cast<int>(format.encoding.matrix)),
                                     std::to_string(static_cast<int>(format.encoding.range)),
                                     std::to_string(frame.modifier)};
  for (int i = 0; i < planeCount(format.pixelFormat); ++i) {
    const hal::DmaBufPlane& plane = frame.dmaBufs.at(static_cast<std::size_t>(i));
    arguments.push_back(std::to_string(plane.offsetBytes));
    arguments.push_back(std::to_string(plane.strideBytes));
  }
  return arguments;
}

std::vector<int> descriptorsOf(const hal::CapturedFrame& frame) {
  std::vector<int> descriptors;
  for (int i = 0; i < planeCount(frame.image.format.pixelFormat); ++i) {
    descriptors.push_back(frame.dmaBufs.at(static_cast<std::size_t>(i)).fd);
  }
  return descriptors;
}

/// The frame of argumentsOf(), with the descriptors that a trial passes on.
struct TriedFrame {
  hal::FrameFormat format;
  std::uint64_t modifier = 0;
  std::array<hal::DmaBufPlane, 3> planes;
};

std::optional<TriedFrame> frameOf(int argc, const char* const* argv) {
  const auto given = TrialProcess::numbersOf(argc, argv);
  if (!given) return std::nullopt;
  const std::vector<std::uint64_t>& numbers = *given;
  constexpr auto kLastFormat = static_cast<std::uint64_t>(hal::PixelFormat::kBayerBggr8);
  if (numbers.size() < kFixed || numbers[0] > kLastFormat || numbers[3] > 1 || numbers[4] > 1) {
    return std::nullopt;
  }
  TriedFrame frame;
  frame.format = {.pixelFormat = static_cast<hal::PixelFormat>(numbers[0]),
                  .size = {static_cast<int>(numbers[1]), static_cast<int>(numbers[2])},
                  .encoding = {.matrix = static_cast<hal::ColorMatrix>(numbers[3]),
                               .range = static_cast<hal::ColorRange>(numbers[4])}};
  frame.modifier = numbers[5];
  const auto count = static_cast<std::size_t>(planeCount(frame.format.pixelFormat));
  if (!isAcceptedSize(frame.format.size) || numbers.size() != kFixed + count * kPerPlane) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < count; ++i) {
    frame.planes.at(i) = {
        .fd = TrialProcess::kFirstDescriptor + static_cast<int>(i),
        .offsetBytes = static_cast<std::size_t>(numbers[kFixed + i * kPerPlane]),
        .strideBytes = static_cast<std::size_t>(numbers[kFixed + i * kPerPlane + 1])};
  }
  return frame;
}

/// The processor's view of the planes. The process ends soon: nothing is unmapped. Nothing where a
/// dma-buf cannot be mapped.
std::optional<hal::ImageView> viewOf(const TriedFrame& frame) {
  hal::ImageView view{.format = frame.format, .planes = {}};
  for (int i = 0; i < planeCount(frame.format.pixelFormat); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const hal::DmaBufPlane& plane = frame.planes.at(at);
    const off_t end = lseek(plane.fd, 0, SEEK_END);
    if (end <= 0 || static_cast<std::size_t>(end) < plane.offsetBytes) return std::nullopt;
    const auto bytes = static_cast<std::size_t>(end);
    void* const address = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, plane.fd, 0);
    if (address == MAP_FAILED) return std::nullopt;
    hal::syncDmaBuf(plane.fd, hal::DmaBufAccess::kBeginRead);
    view.planes.at(at) = {
        .bytes =
            std::span(static_cast<const std::uint8_t*>(address), bytes).subspan(plane.offsetBytes),
        .strideBytes = plane.strideBytes};
  }
  return view.isComplete() ? std::optional(view) : std::nullopt;
}

int judge(const TriedFrame& frame) {
  const EglContext context;
  const ShaderLibrary library;
  FrameUploader uploader(library);
  std::array<Texture, 3> planes;
  for (int i = 0; i < planeCount(frame.format.pixelFormat); ++i) {
    const auto at = static_cast<std::size_t>(i);
    planes.at(at) = importedPlaneTexture(frame.planes.at(at), importedPlane(frame.format, i),
                                         frame.modifier, 0);
  }
  const hal::FrameSize size = frame.format.size;
  const AspectFill fit = aspectFill(size, size);
  uploader.show(frame.format, planes, size, fit);
  const std::vector<std::uint8_t> seen = pixelsOf(uploader.native());
  const std::optional<hal::ImageView> view = viewOf(frame);
  if (!view) return 0;  // the pixels are compared by whoever can see them
  uploader.upload(*view, size, fit);
  return seen == pixelsOf(uploader.native()) ? 0 : kOtherPixels;
}

}  // namespace

FrameTrial::FrameTrial(const hal::CapturedFrame& frame, const hal::Clock& clock)
    : process_(argumentsOf(frame), descriptorsOf(frame), kTask, clock) {}

std::optional<hal::Result<void>> FrameTrial::poll() {
  const std::optional<hal::Result<int>> ended = process_.poll();
  if (!ended) return std::nullopt;
  if (!*ended) return tl::unexpected(ended->error());
  if (**ended == 0) return hal::Result<void>();
  hal::Error error{.kind = hal::ErrorKind::kUnsupported,
                   .subject = "GPU",
                   .problem = "a trial of reading the camera's memory failed",
                   .remedy = {}};
  if (**ended == kOtherPixels) error.problem = "the GPU reads other pixels than the processor does";
  if (**ended == kNoImport)
    error.problem = "the GPU's driver makes no image of the camera's memory";
  return tl::unexpected(std::move(error));
}

std::optional<int> runFrameTrial(int argc, const char* const* argv) {
  if (argc < 2 || std::string_view(argv[1]) != kArgument) return std::nullopt;
  const std::optional<TriedFrame> frame = frameOf(argc, argv);
  if (!frame) return kBadArguments;
  try {
    return judge(*frame);
  } catch (const hal::Failure& failure) {
    std::fprintf(stderr, "pleinair: %s\n", failure.what());
    return failure.error().domain == hal::ErrorDomain::kEgl ? kNoImport : kFailed;
  }
}

std::vector<std::uint8_t> pixelsOf(const Texture& texture) {
  constexpr std::size_t kBytesPerPixel = 4;
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(texture.size().pixels()) *
                                   kBytesPerPixel);
  const RenderTarget target({&texture});
  target.beginKeeping();
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, texture.size().width, texture.size().height, GL_RGBA, GL_UNSIGNED_BYTE,
               pixels.data());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return pixels;
}

std::string differenceText(std::span<const std::uint8_t> seen,
                           std::span<const std::uint8_t> right) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < right.size(); ++i) {
    if (i >= seen.size() || seen[i] != right[i]) ++wrong;
  }
  return fmt::format(
      "the GPU reads other pixels than the processor does ({:.1f} % differ)",
      right.empty() ? 0.0 : 100.0 * static_cast<double>(wrong) / static_cast<double>(right.size()));
}

}  // namespace pleinair::gpu
