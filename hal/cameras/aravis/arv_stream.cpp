#include "hal/cameras/aravis/arv_stream.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "hal/cameras/aravis/packet_filter.h"

namespace pleinair::hal::aravis {
namespace {

BufferStatus statusOf(ArvBufferStatus status) {
  switch (status) {
    case ARV_BUFFER_STATUS_SUCCESS:
      return BufferStatus::kComplete;
    case ARV_BUFFER_STATUS_TIMEOUT:
    case ARV_BUFFER_STATUS_MISSING_PACKETS:
      return BufferStatus::kMissingPackets;
    case ARV_BUFFER_STATUS_SIZE_MISMATCH:
      return BufferStatus::kSizeMismatch;
    case ARV_BUFFER_STATUS_ABORTED:
    case ARV_BUFFER_STATUS_CLEARED:
      return BufferStatus::kAborted;
    default:
      return BufferStatus::kOther;
  }
}

std::uint64_t infoOf(ArvStream* stream, const char* name) {
  for (guint i = 0; i < arv_stream_get_n_infos(stream); ++i) {
    if (std::string_view(arv_stream_get_info_name(stream, i)) == name) {
      return arv_stream_get_info_uint64(stream, i);
    }
  }
  return 0;  // USB counts no packets
}

/// IPv4, in the host's byte order.
std::optional<std::uint32_t> addressOf(GSocketAddress* of) {
  if (!G_IS_INET_SOCKET_ADDRESS(of)) return std::nullopt;
  GInetAddress* const address = g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(of));
  if (g_inet_address_get_family(address) != G_SOCKET_FAMILY_IPV4) return std::nullopt;
  std::uint32_t bytes = 0;
  std::memcpy(&bytes, g_inet_address_to_bytes(address), sizeof bytes);
  return GUINT32_FROM_BE(bytes);
}

/// Counts nothing for USB, or where the camera does not tell the sizes.
MissingPackets packetsOf(ArvCamera* camera) {
  if (arv_camera_is_gv_device(camera) == 0) return {};
  GlibError error;
  const guint packet = arv_camera_gv_get_packet_size(camera, error.out());
  if (error.isSet()) return {};
  const guint payload = arv_camera_get_payload(camera, error.out());
  if (error.isSet()) return {};
  const char* const longIds = arv_camera_get_string(camera, "GevGVSPExtendedIDMode", error.out());
  return {payload, packet,
          !error.isSet() && longIds != nullptr && std::string_view(longIds) == "On"};
}

/// Aravis asserts that there is an image where one is asked for.
void describeImage(ArvBuffer* buffer, Filled& filled) {
  const ArvBufferPayloadType type = arv_buffer_get_payload_type(buffer);
  const bool isImage =
      type == ARV_BUFFER_PAYLOAD_TYPE_IMAGE || type == ARV_BUFFER_PAYLOAD_TYPE_EXTENDED_CHUNK_DATA;
  if (!isImage) {
    filled.status = BufferStatus::kOther;
    return;
  }
  filled.pixelFormat = arv_buffer_get_image_pixel_format(buffer);
  filled.size = {arv_buffer_get_image_width(buffer), arv_buffer_get_image_height(buffer)};
  gint paddingX = 0, paddingY = 0;
  arv_buffer_get_image_padding(buffer, &paddingX, &paddingY);
  filled.paddingBytes = static_cast<std::size_t>(std::max(paddingX, 0));
  size_t allBytes = 0, imageBytes = 0;
  const auto* const all = static_cast<const std::uint8_t*>(arv_buffer_get_data(buffer, &allBytes));
  const auto* const image =
      static_cast<const std::uint8_t*>(arv_buffer_get_image_data(buffer, &imageBytes));
  if (image == nullptr || all == nullptr || image < all) return;
  filled.offsetBytes = static_cast<std::size_t>(image - all);
  filled.usedBytes = imageBytes;
}

}  // namespace

bool ChunkTimes::enable(ArvCamera* camera) {
  GlibError error;
  if (arv_camera_are_chunks_available(camera, error.out()) == 0 || error.isSet()) return false;
  arv_camera_set_chunks(camera, "Timestamp", error.out());
  if (error.isSet()) return false;
  parser_.reset(arv_camera_create_chunk_parser(camera));
  if (arv_camera_is_gv_device(camera) != 0) {
    const guint64 ticks = arv_gv_device_get_timestamp_tick_frequency(
        ARV_GV_DEVICE(arv_camera_get_device(camera)), error.out());
    if (!error.isSet() && ticks > 0) ticksPerSecond_ = static_cast<double>(ticks);
  }
  return parser_ != nullptr;
}

std::optional<Duration> ChunkTimes::of(ArvBuffer* buffer) const {
  if (!parser_ || arv_buffer_has_chunks(buffer) == 0) return std::nullopt;
  GlibError error;
  const gint64 ticks =
      arv_chunk_parser_get_integer_value(parser_.get(), buffer, "ChunkTimestamp", error.out());
  if (error.isSet() || ticks <= 0) return std::nullopt;
  const double nanoseconds = static_cast<double>(ticks) * (1e9 / ticksPerSecond_);
  if (nanoseconds > 9e18) return std::nullopt;
  return Duration(static_cast<std::int64_t>(nanoseconds));
}

ArvStreamOfCamera::ArvStreamOfCamera(Object<ArvCamera> camera, Object<ArvStream> stream,
                                     std::shared_ptr<const ChunkTimes> chunkTimes)
    : camera_(std::move(camera)),
      stream_(std::move(stream)),
      chunkTimes_(std::move(chunkTimes)),
      missing_(packetsOf(camera_.get())) {}

ArvStreamOfCamera::~ArvStreamOfCamera() {
  GlibError error;
  arv_camera_stop_acquisition(camera_.get(), error.out());  // fails if it is gone
}

void ArvStreamOfCamera::guard(std::size_t bufferBytes) {
  isGuarded_ = !ARV_IS_GV_STREAM(stream_.get()) || filterUdp(bufferBytes);
}

bool ArvStreamOfCamera::filterUdp(std::size_t bufferBytes) {
  ArvGvDevice* const device = ARV_GV_DEVICE(arv_camera_get_device(camera_.get()));
  const auto camera = addressOf(arv_gv_device_get_device_address(device));
  if (!camera) return false;
  GlibError error;
  const gint packetBytes = arv_camera_gv_get_packet_size(camera_.get(), error.out());
  if (error.isSet() || packetBytes <= 0) return false;
  return filterPackets(addressOf(arv_gv_device_get_interface_address(device)).value_or(0),
                       arv_gv_stream_get_port(ARV_GV_STREAM(stream_.get())),
                       {.camera = *camera,
                        .bufferBytes = bufferBytes,
                        .packetBytes = static_cast<std::uint32_t>(packetBytes)});
}

void ArvStreamOfCamera::add(std::vector<std::span<std::uint8_t>> buffers) {
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    // The index is told apart from "no user data" by 1.
    buffers_.push_back(arv_buffer_new_full(buffers[i].size(), buffers[i].data(),
                                           GSIZE_TO_POINTER(i + 1), nullptr));
    handles_.emplace_back(buffers_.back());
    g_object_ref(buffers_.back());  // the stream takes a reference over with each push
    arv_stream_push_buffer(stream_.get(), buffers_.back());
  }
}

std::optional<Filled> ArvStreamOfCamera::pop(Duration timeout) {
  const auto microseconds = std::chrono::duration_cast<std::chrono::microseconds>(timeout);
  ArvBuffer* const buffer = microseconds.count() <= 0
                                ? arv_stream_try_pop_buffer(stream_.get())
                                : arv_stream_timeout_pop_buffer(
                                      stream_.get(), static_cast<guint64>(microseconds.count()));
  if (buffer == nullptr) return std::nullopt;
  Filled filled = describe(buffer);
  if (filled.status != BufferStatus::kAborted) countMissing(buffer, filled.status);
  g_object_unref(buffer);  // handles_ still has one
  return filled;
}

void ArvStreamOfCamera::push(std::size_t index) {
  g_object_ref(buffers_[index]);
  arv_stream_push_buffer(stream_.get(), buffers_[index]);
}

StreamCounts ArvStreamOfCamera::counts() const {
  StreamCounts counts;
  guint64 completed = 0, failures = 0, underruns = 0;
  arv_stream_get_statistics(stream_.get(), &completed, &failures, &underruns);
  counts.underruns = underruns;
  counts.missingPackets =
      missing_.counts() ? missing_.count() : infoOf(stream_.get(), "n_missing_packets");
  counts.resentPackets = infoOf(stream_.get(), "n_resent_packets");
  counts.ignoredPackets = infoOf(stream_.get(), "n_ignored_packets");
  return counts;
}

void ArvStreamOfCamera::countMissing(ArvBuffer* buffer, BufferStatus status) {
  if (!missing_.counts()) return;
  size_t bytes = 0;
  arv_buffer_get_data(buffer, &bytes);
  const std::uint64_t others = infoOf(stream_.get(), "n_duplicated_packets") +
                               infoOf(stream_.get(), "n_error_packets") +
                               infoOf(stream_.get(), "n_ignored_packets");
  const std::uint64_t received = infoOf(stream_.get(), "n_received_packets");
  const bool isWhole = status == BufferStatus::kComplete && bytes > 0;
  missing_.frameEnded(received - std::min(received, others),
                      isWhole ? std::optional<std::size_t>(bytes) : std::nullopt);
}

Filled ArvStreamOfCamera::describe(ArvBuffer* buffer) const {
  Filled filled;
  const gsize tag = GPOINTER_TO_SIZE(arv_buffer_get_user_data(buffer));
  filled.index = tag - 1;
  filled.status = statusOf(arv_buffer_get_status(buffer));
  if (filled.status == BufferStatus::kAborted) return filled;
  filled.frameId = arv_buffer_get_frame_id(buffer);
  filled.deviceTime = Duration(
      static_cast<std::int64_t>(std::min<guint64>(arv_buffer_get_timestamp(buffer), G_MAXINT64)));
  const auto system = static_cast<std::int64_t>(
      std::min<guint64>(arv_buffer_get_system_timestamp(buffer), G_MAXINT64));
  if (system > 0) filled.age = Duration(g_get_real_time() * 1000 - system);
  // Of a frame that is not complete, even the packet that describes it may be lost.
  if (filled.status != BufferStatus::kComplete) return filled;
  describeImage(buffer, filled);
  if (chunkTimes_) filled.chunkTime = chunkTimes_->of(buffer);
  return filled;
}

}  // namespace pleinair::hal::aravis
