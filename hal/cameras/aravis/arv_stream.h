#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hal/cameras/aravis/arv_handles.h"
#include "hal/cameras/aravis/library.h"
#include "hal/cameras/aravis/missing_packets.h"
#include "hal/clock.h"

namespace pleinair::hal::aravis {

/// Reads the time of a frame from its chunk data, if the camera sends it there. One thread.
class ChunkTimes {
 public:
  /// Asks the camera for chunk data. Gives whether it sends the time in it.
  bool enable(ArvCamera* camera);
  /// On the device's clock.
  std::optional<Duration> of(ArvBuffer* buffer) const;

 private:
  Object<ArvChunkParser> parser_;
  double ticksPerSecond_ = 1e9;  ///< USB3 Vision counts nanoseconds
};

/// A stream of Aravis' that has been made for a camera. The destructor stops the acquisition.
class ArvStreamOfCamera final : public Stream {
 public:
  ArvStreamOfCamera(Object<ArvCamera> camera, Object<ArvStream> stream,
                    std::shared_ptr<const ChunkTimes> chunkTimes);
  ~ArvStreamOfCamera() override;

  /// Keeps packets from it that no camera sends (packet_filter.h), for buffers of this size. Before
  /// the acquisition starts. Packets that are read below the UDP socket are not looked at.
  void guard(std::size_t bufferBytes);
  /// Gives it the memory of its buffers, which outlives it. Before the acquisition starts.
  void add(std::vector<std::span<std::uint8_t>> buffers);

  std::optional<Filled> pop(Duration timeout) override;
  void push(std::size_t index) override;
  StreamCounts counts() const override;
  bool isGuarded() const override { return isGuarded_; }

 private:
  bool filterUdp(std::size_t bufferBytes);
  void countMissing(ArvBuffer* buffer, BufferStatus status);
  Filled describe(ArvBuffer* buffer) const;

  Object<ArvCamera> camera_;
  Object<ArvStream> stream_;
  std::shared_ptr<const ChunkTimes> chunkTimes_;
  MissingPackets missing_;
  bool isGuarded_ = true;
  std::vector<ArvBuffer*> buffers_;
  std::vector<Object<ArvBuffer>> handles_;
};

}  // namespace pleinair::hal::aravis
