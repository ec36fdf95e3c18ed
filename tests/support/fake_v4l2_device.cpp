#include "tests/support/fake_v4l2_device.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "hal/cameras/v4l2/layout.h"
#include "tests/support/test_pictures.h"

namespace pleinair::support {
namespace {

template <std::size_t kSize>
void copyText(__u8 (&field)[kSize], const std::string& text) {
  std::memcpy(field, text.data(), std::min(kSize, text.size()));
}

std::uint32_t u32(std::size_t value) {
  return static_cast<std::uint32_t>(value);
}
std::uint32_t u32(int value) {
  return static_cast<std::uint32_t>(value);
}

}  // namespace

std::uint32_t FakeV4l2::Device::type() const {
  return isMultiPlanar() ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
}

hal::Duration FakeV4l2::Device::framePeriod() const {
  return std::chrono::nanoseconds(1'000'000'000LL * period.numerator / period.denominator);
}

int FakeV4l2::Device::answer(int fd, unsigned long request, void* argument) {
  if (lost) return -*lost;
  if (const auto failure = video.failures.find(request); failure != video.failures.end()) {
    return -failure->second;
  }
  advance();
  switch (request) {
    case VIDIOC_QUERYCAP:
      return queryCapability(*static_cast<v4l2_capability*>(argument));
    case VIDIOC_ENUM_FMT:
      return enumerateFormat(*static_cast<v4l2_fmtdesc*>(argument));
    case VIDIOC_ENUM_FRAMESIZES:
      return enumerateSize(*static_cast<v4l2_frmsizeenum*>(argument));
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return enumerateInterval(*static_cast<v4l2_frmivalenum*>(argument));
    case VIDIOC_G_FMT:
      if (video.formats.empty()) return -EINVAL;
      describeFormat(*static_cast<v4l2_format*>(argument));
      return 0;
    case VIDIOC_S_FMT:
      return setFormat(*static_cast<v4l2_format*>(argument));
    case VIDIOC_G_PARM:
      return parameters(*static_cast<v4l2_streamparm*>(argument), false);
    case VIDIOC_S_PARM:
      return parameters(*static_cast<v4l2_streamparm*>(argument), true);
    case VIDIOC_REQBUFS:
      return requestBuffers(fd, *static_cast<v4l2_requestbuffers*>(argument));
    case VIDIOC_QUERYBUF:
      return queryBuffer(*static_cast<v4l2_buffer*>(argument));
    case VIDIOC_QBUF:
      return queue(*static_cast<v4l2_buffer*>(argument));
    case VIDIOC_DQBUF:
      return dequeue(*static_cast<v4l2_buffer*>(argument));
    case VIDIOC_EXPBUF:
      return exportBuffer(*static_cast<v4l2_exportbuffer*>(argument));
    case VIDIOC_STREAMON:
    case VIDIOC_STREAMOFF:
      if (u32(*static_cast<int*>(argument)) != type()) return -EINVAL;
      return switchStream(request == VIDIOC_STREAMON);
    case VIDIOC_SUBSCRIBE_EVENT:
      eventsWanted = true;
      return 0;
    case VIDIOC_DQEVENT: {
      if (!eventPending) return -ENOENT;
      eventPending = video.eventsNeverEnd;
      auto& event = *static_cast<v4l2_event*>(argument);
      event.type = V4L2_EVENT_SOURCE_CHANGE;
      event.u.src_change.changes = V4L2_EVENT_SRC_CH_RESOLUTION;
      return 0;
    }
    case VIDIOC_QUERYCTRL:
      return queryControl(*static_cast<v4l2_queryctrl*>(argument));
    case VIDIOC_QUERYMENU:
      return queryMenu(*static_cast<v4l2_querymenu*>(argument));
    case VIDIOC_S_CTRL:
      return setControl(*static_cast<v4l2_control*>(argument));
    case VIDIOC_G_CTRL:
      return readControl(*static_cast<v4l2_control*>(argument));
    default:
      return -ENOTTY;
  }
}

int FakeV4l2::Device::queryCapability(v4l2_capability& capability) const {
  copyText(capability.driver, video.driver);
  copyText(capability.card, video.card);
  copyText(capability.bus_info, video.bus);
  capability.device_caps = video.caps;
  // The whole device has more capabilities than this node.
  capability.capabilities = video.caps | V4L2_CAP_DEVICE_CAPS | V4L2_CAP_META_CAPTURE;
  return 0;
}

int FakeV4l2::Device::enumerateFormat(v4l2_fmtdesc& entry) const {
  if (entry.type != type() || entry.index >= video.formats.size()) return -EINVAL;
  entry.pixelformat = video.formats[entry.index].fourcc;
  return 0;
}

int FakeV4l2::Device::enumerateSize(v4l2_frmsizeenum& entry) const {
  const auto found = std::ranges::find(video.formats, entry.pixel_format, &FakeFormat::fourcc);
  if (found == video.formats.end()) return -EINVAL;
  if (!found->step) {
    if (entry.index >= found->sizes.size()) return -EINVAL;
    entry.type = V4L2_FRMSIZE_TYPE_DISCRETE;
    entry.discrete = {u32(found->sizes[entry.index].width), u32(found->sizes[entry.index].height)};
    return 0;
  }
  if (entry.index > 0) return -EINVAL;
  entry.type = V4L2_FRMSIZE_TYPE_STEPWISE;
  entry.stepwise = {.min_width = u32(found->sizes.front().width),
                    .max_width = u32(found->sizes.back().width),
                    .step_width = u32(found->step->width),
                    .min_height = u32(found->sizes.front().height),
                    .max_height = u32(found->sizes.back().height),
                    .step_height = u32(found->step->height)};
  return 0;
}

int FakeV4l2::Device::enumerateInterval(v4l2_frmivalenum& entry) const {
  const auto found = std::ranges::find(video.formats, entry.pixel_format, &FakeFormat::fourcc);
  if (found == video.formats.end() || entry.index >= found->periods.size()) return -EINVAL;
  entry.type = V4L2_FRMIVAL_TYPE_DISCRETE;
  entry.discrete = found->periods[entry.index];
  return 0;
}

int FakeV4l2::Device::setFormat(v4l2_format& wanted) {
  if (wanted.type != type() || video.formats.empty()) return -EINVAL;
  if (!buffers.empty()) return -EBUSY;
  const std::uint32_t fourcc =
      isMultiPlanar() ? wanted.fmt.pix_mp.pixelformat : wanted.fmt.pix.pixelformat;
  const hal::FrameSize asked = isMultiPlanar()
                                   ? hal::FrameSize{static_cast<int>(wanted.fmt.pix_mp.width),
                                                    static_cast<int>(wanted.fmt.pix_mp.height)}
                                   : hal::FrameSize{static_cast<int>(wanted.fmt.pix.width),
                                                    static_cast<int>(wanted.fmt.pix.height)};
  const auto found = std::ranges::find(video.formats, fourcc, &FakeFormat::fourcc);
  // Like a driver, replaces an unsupported format by a supported one.
  formatIndex =
      found == video.formats.end() ? 0 : static_cast<std::size_t>(found - video.formats.begin());
  const auto& sizes = format().sizes;
  if (format().step) {
    size = {std::clamp(asked.width, sizes.front().width, sizes.back().width),
            std::clamp(asked.height, sizes.front().height, sizes.back().height)};
  } else {
    size = *std::ranges::min_element(sizes, {}, [&](hal::FrameSize each) {
      return std::abs(each.width - asked.width) + std::abs(each.height - asked.height);
    });
  }
  period = format().periods.empty() ? v4l2_fract{1, 25} : format().periods.front();
  wanted = {};
  describeFormat(wanted);
  if (video.amendFormat) video.amendFormat(wanted);
  return 0;
}

void FakeV4l2::Device::describeFormat(v4l2_format& answer) const {
  const hal::FrameSize now = size.width > 0 ? size : format().sizes.front();
  answer.type = type();
  const std::vector<std::size_t> planes = planeSizes();
  if (isMultiPlanar()) {
    v4l2_pix_format_mplane& pix = answer.fmt.pix_mp;
    pix.width = u32(now.width);
    pix.height = u32(now.height);
    pix.pixelformat = format().fourcc;
    pix.field = V4L2_FIELD_NONE;
    pix.colorspace = video.colorspace;
    pix.ycbcr_enc = static_cast<__u8>(video.encoding);
    pix.quantization = static_cast<__u8>(video.quantization);
    pix.num_planes = static_cast<__u8>(planes.size());
    for (std::size_t i = 0; i < planes.size(); ++i) {
      pix.plane_fmt[i].bytesperline = video.reportsNoStride ? 0 : u32(strides()[i]);
      pix.plane_fmt[i].sizeimage = u32(planes[i]);
    }
    return;
  }
  v4l2_pix_format& pix = answer.fmt.pix;
  pix.width = u32(now.width);
  pix.height = u32(now.height);
  pix.pixelformat = format().fourcc;
  pix.field = V4L2_FIELD_NONE;
  pix.bytesperline = video.reportsNoStride ? 0 : u32(strides()[0]);
  pix.sizeimage = u32(planes[0]);
  pix.colorspace = video.colorspace;
  pix.ycbcr_enc = video.encoding;
  pix.quantization = video.quantization;
  pix.priv = V4L2_PIX_FMT_PRIV_MAGIC;
}

int FakeV4l2::Device::parameters(v4l2_streamparm& parm, bool set) {
  if (parm.type != type()) return -EINVAL;
  if (set && !format().periods.empty()) {
    const v4l2_fract wanted = parm.parm.capture.timeperframe;
    period = *std::ranges::min_element(format().periods, {}, [&](const v4l2_fract& each) {
      return std::abs(double(each.numerator) / each.denominator -
                      double(wanted.numerator) / wanted.denominator);
    });
  }
  parm.parm.capture = {};
  parm.parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
  parm.parm.capture.timeperframe = period;
  return 0;
}

FakeControl* FakeV4l2::Device::control(std::uint32_t id) {
  const auto found = std::ranges::find(video.controls, id, &FakeControl::id);
  return found == video.controls.end() ? nullptr : &*found;
}

int FakeV4l2::Device::queryControl(v4l2_queryctrl& query) const {
  const auto found = std::ranges::find(video.controls, query.id, &FakeControl::id);
  if (found == video.controls.end()) return -EINVAL;
  query.minimum = found->min;
  query.maximum = found->max;
  query.step = found->step;
  query.flags = found->flags;
  return 0;
}

int FakeV4l2::Device::queryMenu(v4l2_querymenu& query) const {
  const auto found = std::ranges::find(video.controls, query.id, &FakeControl::id);
  if (found == video.controls.end() || !found->menu.contains(query.index)) return -EINVAL;
  return 0;
}

int FakeV4l2::Device::setControl(v4l2_control& wanted) {
  FakeControl* found = control(wanted.id);
  if (found == nullptr) return -EINVAL;
  const bool isStep = (wanted.value - found->min) % found->step == 0;
  if (wanted.value < found->min || wanted.value > found->max || !isStep) return -ERANGE;
  if (!found->menu.empty() && !found->menu.contains(u32(wanted.value))) return -EINVAL;
  found->value = found->kept.value_or(wanted.value);
  return 0;
}

int FakeV4l2::Device::readControl(v4l2_control& read) const {
  const auto found = std::ranges::find(video.controls, read.id, &FakeControl::id);
  if (found == video.controls.end()) return -EINVAL;
  if ((found->flags & V4L2_CTRL_FLAG_WRITE_ONLY) != 0) return -EACCES;
  read.value = found->value;
  return 0;
}

}  // namespace pleinair::support
