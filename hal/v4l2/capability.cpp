#include "hal/v4l2/capability.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <iterator>
#include <system_error>

#include <linux/videodev2.h>

#include "hal/printable.h"

namespace pleinair::hal::v4l2 {
namespace {

/// Reads one of the kernel's fixed-size text fields, which need not end in a zero.
template <std::size_t kSize>
std::string textOf(const __u8 (&field)[kSize]) {
  return printable(
      std::string(std::begin(field), std::find(std::begin(field), std::end(field), 0)));
}

}  // namespace

bool Capability::capturesVideo() const {
  return has(V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE) &&
         !has(V4L2_CAP_VIDEO_M2M | V4L2_CAP_VIDEO_M2M_MPLANE);
}

bool Capability::outputsVideo() const {
  return has(V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_VIDEO_OUTPUT_MPLANE) &&
         !has(V4L2_CAP_VIDEO_M2M | V4L2_CAP_VIDEO_M2M_MPLANE);
}

Result<Capability> queryCapability(SystemCalls& calls, int fd, const std::string& subject) {
  v4l2_capability answer{};
  if (const int result = calls.ioctl(fd, VIDIOC_QUERYCAP, &answer); result < 0) {
    if (result == -ENOTTY) {
      return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                  .subject = subject,
                                  .problem = "not a V4L2 device",
                                  .remedy = "give a node such as /dev/video0",
                                  .domain = ErrorDomain::kErrno,
                                  .code = ENOTTY});
    }
    return tl::unexpected(errnoError(subject, "cannot query its capabilities", -result));
  }
  const bool perNode = (answer.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
  return Capability{.driver = textOf(answer.driver),
                    .card = textOf(answer.card),
                    .bus = textOf(answer.bus_info),
                    .flags = perNode ? answer.device_caps : answer.capabilities};
}

std::optional<int> videoNumber(std::string_view name) {
  constexpr std::string_view kPrefix = "video";
  if (!name.starts_with(kPrefix)) return std::nullopt;
  name.remove_prefix(kPrefix.size());
  int number = 0;
  const char* const last = name.data() + name.size();
  const auto [end, failure] = std::from_chars(name.data(), last, number);
  if (failure != std::errc() || end != last || number < 0) return std::nullopt;
  return number;
}

}  // namespace pleinair::hal::v4l2
