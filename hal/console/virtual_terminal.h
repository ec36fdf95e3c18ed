#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "hal/error.h"

namespace pleinair::hal {

/// The kernel's virtual terminals (consoles); tests replace it. One thread.
class Terminals {
 public:
  virtual ~Terminals() = default;
  Terminals() = default;
  Terminals(const Terminals&) = delete;
  Terminals& operator=(const Terminals&) = delete;

  /// Takes the controlling terminal, where that is a virtual one, else the one in front, and from
  /// then on is asked before another comes to the front (VT_PROCESS). Answers its number. Errors:
  /// kNotFound (there are none), kPermissionDenied, kBusy (a desktop controls it), kIo.
  virtual Result<int> take() = 0;
  /// Lets it go: the kernel switches as it likes.
  virtual void release() = 0;

  /// The number of the one in front; 0: unknown.
  virtual int front() = 0;
  virtual void bringToFront(int number) = 0;

  enum class Request {
    kNone,
    kLeave,   ///< another wants to come to the front, and waits for allowLeave()
    kReturn,  ///< ours is in front again
  };
  /// What has been asked since the last call.
  virtual Request takeRequest() = 0;
  virtual void allowLeave() = 0;
  virtual void acknowledgeReturn() = 0;
};

/// The kernel's. Its requests come as the signals SIGUSR1 and SIGUSR2, whose handlers take() sets
/// for good.
Terminals& kernelTerminals();

/// The virtual terminal that displays without a desktop appear on. Other consoles may come to the
/// front meanwhile (Ctrl+Alt+F2, chvt). One thread.
///
/// If the process is killed, the kernel finds nobody to ask at the next switch, and switches by
/// itself from then on.
class VirtualTerminal {
 public:
  /// What has to be done before another console comes to the front, and once ours is there again.
  struct Switching {
    std::function<void()> leave;
    std::function<void()> enter;
  };

  /// Takes one and brings it to the front. `terminals` outlives it. Errors: those of
  /// Terminals::take(); without a virtual terminal displays are kept whatever console is in front.
  static Result<std::unique_ptr<VirtualTerminal>> open(Terminals& terminals, Switching switching);
  ~VirtualTerminal();
  VirtualTerminal(const VirtualTerminal&) = delete;
  VirtualTerminal& operator=(const VirtualTerminal&) = delete;

  /// Follows what the kernel asks for; to be called several times a second, since the kernel waits.
  /// Returns whether another console came to the front, or ours.
  bool follow();
  bool isInFront() const { return isInFront_; }
  int number() const { return number_; }

 private:
  VirtualTerminal(Terminals& terminals, Switching switching, int number);

  Terminals& terminals_;
  Switching switching_;
  int number_ = 0;
  bool isInFront_ = true;
};

}  // namespace pleinair::hal
