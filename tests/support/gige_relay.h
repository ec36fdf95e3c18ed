#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace pleinair::support {

/// What a relay does to the packets of a stream, each by chance.
struct LinkFaults {
  double lost = 0;            ///< the packet is dropped
  double reordered = 0;       ///< it comes after the next one
  double beyondRecovery = 0;  ///< of the lost ones: the camera does not have it any more either
  std::uint64_t frames = 0;   ///< so many frames are affected; those after them pass
  unsigned seed = 1;
};

/// Packets of a stream, each counted once. Those that were sent again are not among the passed.
struct RelayCounts {
  std::uint64_t passed = 0, reordered = 0;
  std::uint64_t injected = 0;        ///< dropped when they came first
  std::uint64_t recovered = 0;       ///< of these: delivered once they were asked for again
  std::uint64_t framesWithLoss = 0;  ///< frames with some that were dropped
  std::uint64_t framesNotWhole = 0;  ///< frames with some that were dropped and not recovered
};

/// A GigE Vision camera at 127.0.0.2 that is another one (gige_simulator.h) behind a bad link. What
/// goes over its control channel is passed on; of its stream's packets some are lost and some come
/// in another order, and it sends packets again where it is asked to, from its memory of them, as
/// real cameras do: Aravis' simulator does not. One stream. The thread ends with this.
class GigeRelay {
 public:
  static constexpr const char* kAddress = "127.0.0.2";

  /// `camera`: the address of the other one.
  explicit GigeRelay(LinkFaults faults, const std::string& camera = "127.0.0.1");
  ~GigeRelay();
  GigeRelay(const GigeRelay&) = delete;
  GigeRelay& operator=(const GigeRelay&) = delete;

  bool isRunning() const;
  /// Pulls the cable or plugs it in: meanwhile nothing passes in any direction. Any thread.
  void setUnplugged(bool isUnplugged);
  /// Sends the program's stream a packet that the camera has not made. Any thread.
  void sendAlien(std::span<const std::uint8_t> bytes);
  /// Any thread.
  RelayCounts counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pleinair::support
