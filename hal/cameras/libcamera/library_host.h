#pragma once

#include <chrono>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <sys/types.h>

#include "hal/cameras/libcamera/host_channel.h"
#include "hal/cameras/libcamera/host_message.h"
#include "hal/cameras/libcamera/hosted_library.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "hal/file_descriptor.h"

namespace pleinair::hal::libcamera {

/// A child process, which is ended with this. One thread at a time.
class HostProcess {
 public:
  explicit HostProcess(pid_t process) : process_(process) {}
  HostProcess(const HostProcess&) = delete;
  HostProcess& operator=(const HostProcess&) = delete;
  ~HostProcess();

  /// Waits for its end, and then kills it. A process that hangs in a driver outlives that: it is
  /// looked for whenever another one ends.
  void end(Duration limit);
  /// How it has ended: "was ended by signal 6".
  std::string endText();

 private:
  bool waitFor(Duration limit);

  pid_t process_;
  int status_ = 0;
};

/// A host and the channels to it. One thread at a time.
class Host {
 public:
  explicit Host(StartedHost started)
      : process_(started.process),
        calls_(std::move(started.calls)),
        frames_(std::move(started.frames)) {}
  ~Host() {
    calls_.close();
    frames_.close();
    process_.end(isWell_ ? kLimitOfEnding : Duration::zero());
  }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  HostChannel& frames() { return frames_; }
  std::string lossText() { return "is lost: the process of libcamera " + process_.endText(); }
  /// It is killed at its end, without a chance to close the camera.
  void giveUp() { isWell_ = false; }

  /// Sends a call with its arguments and waits for the answer.
  template <class T, class... Arguments>
  Result<T> call(Call what, Duration limit, const Arguments&... arguments) {
    MessageWriter message;
    message.put(what);
    (message.put(arguments), ...);
    if (!isWell_ || !calls_.send(message.bytes())) return tl::unexpected(ended());
    switch (calls_.receive(answer_, limit)) {
      case HostChannel::Reception::kMessage:
        return answerOf<T>(what);
      case HostChannel::Reception::kClosed:
        return tl::unexpected(ended());
      case HostChannel::Reception::kTimeout:
        break;
    }
    giveUp();
    return tl::unexpected(
        Error{.kind = ErrorKind::kTimeout,
              .problem = "libcamera gave no answer for " + durationText(limit),
              .remedy = "unplug the camera, or start the computer anew if it is built in"});
  }
  /// The descriptors of the last answer.
  std::vector<FileDescriptor>& descriptors() { return answer_.descriptors; }

 private:
  /// What it has to end by itself.
  static constexpr Duration kLimitOfEnding = std::chrono::milliseconds(200);

  template <class T>
  Result<T> answerOf(Call what) {
    MessageReader reader(answer_.bytes);
    Call call{};
    bool isGood = false;
    reader.take(call, kLastCall);
    reader.take(isGood);
    if (reader.isValid() && call == what && !isGood) {
      Error error;
      reader.take(error);
      if (reader.isValid()) return tl::unexpected(std::move(error));
    } else if (reader.isValid() && call == what) {
      if constexpr (std::is_void_v<T>) {
        return {};
      } else {
        T value{};
        reader.take(value);
        if (reader.isValid()) return value;
      }
    }
    giveUp();
    return tl::unexpected(
        Error{.kind = ErrorKind::kInternal, .problem = "the process of libcamera makes no sense"});
  }

  Error ended() {
    giveUp();
    return {.kind = ErrorKind::kIo,
            .problem = "the process of libcamera " + process_.endText(),
            .remedy = "its last lines in the log say why"};
  }

  HostProcess process_;
  HostChannel calls_, frames_;
  HostMessage answer_;
  bool isWell_ = true;
};

}  // namespace pleinair::hal::libcamera
