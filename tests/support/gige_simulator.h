#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace pleinair::support {

/// Moves this process into a network of its own whose loopback device is up, so that simulated
/// cameras of several test processes do not meet. Call it before any thread is made. False where
/// the system does not allow that; the process is then unchanged.
bool enterPrivateNetwork();
/// Sets the MTU of the loopback device of the private network. False if it may not.
bool setLoopbackMtu(int bytes);

/// A GigE Vision camera on 127.0.0.1, by Aravis' own simulator: real packets over the loopback
/// device. Pixel i of frame n is i + n, counted from the first frame.
class GigeSimulator {
 public:
  explicit GigeSimulator(const std::string& serial = "GV01");
  /// The camera is gone from the network at once, as if its power was cut.
  ~GigeSimulator();
  GigeSimulator(const GigeSimulator&) = delete;
  GigeSimulator& operator=(const GigeSimulator&) = delete;

  bool isRunning() const;
  std::uint64_t framesMade() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pleinair::support
