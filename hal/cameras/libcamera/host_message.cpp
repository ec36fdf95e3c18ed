#include "hal/cameras/libcamera/host_message.h"

#include "hal/printable.h"

namespace pleinair::hal::libcamera {

void MessageWriter::put(std::string_view text) {
  put(static_cast<std::uint32_t>(text.size()));
  bytes_.insert(bytes_.end(), text.begin(), text.end());
}

void MessageWriter::put(const FrameSize& size) {
  put(size.width);
  put(size.height);
}

void MessageWriter::put(const Error& error) {
  put(error.kind);
  put(error.subject);
  put(error.problem);
  put(error.remedy);
  put(error.domain);
  put(error.code);
}

void MessageWriter::put(const FoundCamera& camera) {
  put(camera.id);
  put(camera.model);
  put(camera.isUsb);
}

void MessageWriter::put(const OfferedFormat& format) {
  put(format.fourcc);
  put(format.sizes);
}

void MessageWriter::put(const StreamWish& wish) {
  put(wish.fourcc);
  put(wish.size);
  put(wish.buffers);
  put(wish.orientation);
  put(wish.luma);
}

void MessageWriter::put(const StreamImage& image) {
  put(image.fourcc);
  put(image.size);
  put(static_cast<std::uint64_t>(image.strideBytes));
}

void MessageWriter::put(const StreamAnswer& answer) {
  put(answer.fourcc);
  put(answer.size);
  put(static_cast<std::uint64_t>(answer.strideBytes));
  put(answer.encoding.matrix);
  put(answer.encoding.range);
  put(answer.encoding.primaries);
  put(answer.encoding.transfer);
  put(answer.isOrientationKept);
  put(answer.luma);
}

void MessageWriter::put(const ControlRange& range) {
  put(range.min);
  put(range.max);
}

void MessageWriter::put(const StartSettings& settings) {
  for (const auto& each : settings.controls) {
    put(each.has_value());
    if (!each) continue;
    const double* const value = std::get_if<double>(&*each);
    put(value == nullptr);
    put(value == nullptr ? 0.0 : *value);
  }
  put(settings.framePeriod);
}

void MessageWriter::put(const Completed& completed) {
  put(static_cast<std::uint64_t>(completed.index));
  put(completed.isFaulty);
  put(completed.isCancelled);
  put(completed.sequence);
  put(completed.timestamp);
  put(completed.sensorTime);
  for (const std::size_t each : completed.usedBytes) put(static_cast<std::uint64_t>(each));
  for (const std::size_t each : completed.lumaUsedBytes) put(static_cast<std::uint64_t>(each));
}

void MessageWriter::put(const SharedPlane& plane) {
  put(plane.descriptor);
  put(plane.offset);
  put(plane.length);
}

void MessageWriter::put(const SharedStream& stream) {
  put(stream.frames);
  put(stream.luma);
}

void MessageReader::take(bool& value) {
  std::uint8_t byte = 0;
  take(byte);
  value = byte == 1;
  if (byte > 1) fail();
}

void MessageReader::take(std::string& text) {
  std::uint32_t length = 0;
  take(length);
  text.clear();
  if (length > rest_.size()) return fail();
  text.assign(rest_.begin(), rest_.begin() + length);
  rest_ = rest_.subspan(length);
}

void MessageReader::take(Duration& time) {
  std::int64_t count = 0;
  take(count);
  time = Duration(count);
}

void MessageReader::take(FrameSize& size) {
  take(size.width);
  take(size.height);
}

void MessageReader::take(Error& error) {
  take(error.kind, ErrorKind::kInternal);
  for (std::string* const text : {&error.subject, &error.problem, &error.remedy}) {
    take(*text);
    *text = printable(*text);
  }
  take(error.domain, ErrorDomain::kGl);
  take(error.code);
}

void MessageReader::take(FoundCamera& camera) {
  take(camera.id);
  take(camera.model);
  take(camera.isUsb);
}

void MessageReader::take(OfferedFormat& format) {
  take(format.fourcc);
  take(format.sizes);
}

void MessageReader::take(StreamWish& wish) {
  take(wish.fourcc);
  take(wish.size);
  take(wish.buffers);
  take(wish.orientation, Orientation::kFlipped);
  take(wish.luma);
}

void MessageReader::take(StreamImage& image) {
  std::uint64_t stride = 0;
  take(image.fourcc);
  take(image.size);
  take(stride);
  image.strideBytes = stride;
}

void MessageReader::take(StreamAnswer& answer) {
  std::uint64_t stride = 0;
  take(answer.fourcc);
  take(answer.size);
  take(stride);
  answer.strideBytes = stride;
  take(answer.encoding.matrix, ColorMatrix::kBt709);
  take(answer.encoding.range, ColorRange::kFull);
  take(answer.encoding.primaries, ColorPrimaries::kOther);
  take(answer.encoding.transfer, ColorTransfer::kOther);
  take(answer.isOrientationKept);
  take(answer.luma);
}

void MessageReader::take(ControlRange& range) {
  take(range.min);
  take(range.max);
}

void MessageReader::take(StartSettings& settings) {
  for (auto& each : settings.controls) {
    each.reset();
    bool isThere = false;
    take(isThere);
    if (!isThere) continue;
    bool isAutomatic = false;
    double value = 0;
    take(isAutomatic);
    take(value);
    if (isAutomatic) {
      each = Automatic{};
    } else {
      each = value;
    }
  }
  take(settings.framePeriod);
}

void MessageReader::take(Completed& completed) {
  std::uint64_t index = 0;
  take(index);
  completed.index = index;
  take(completed.isFaulty);
  take(completed.isCancelled);
  take(completed.sequence);
  take(completed.timestamp);
  take(completed.sensorTime);
  for (auto* const used : {&completed.usedBytes, &completed.lumaUsedBytes}) {
    for (std::size_t& each : *used) {
      std::uint64_t bytes = 0;
      take(bytes);
      each = bytes;
    }
  }
}

void MessageReader::take(SharedPlane& plane) {
  take(plane.descriptor);
  take(plane.offset);
  take(plane.length);
}

void MessageReader::take(SharedStream& stream) {
  take(stream.frames);
  take(stream.luma);
}

}  // namespace pleinair::hal::libcamera
