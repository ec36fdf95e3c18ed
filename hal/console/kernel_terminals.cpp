#include <atomic>
#include <cerrno>
#include <csignal>
#include <optional>
#include <string>
#include <utility>

#include <fcntl.h>
#include <linux/kd.h>
#include <linux/vt.h>
#include <sys/ioctl.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

#include "hal/console/virtual_terminal.h"
#include "hal/file_descriptor.h"

namespace pleinair::hal {
namespace {

constexpr int kLeaveSignal = SIGUSR1;
constexpr int kReturnSignal = SIGUSR2;
constexpr unsigned kTtyMajor = 4;
constexpr unsigned kMaxTerminal = 63;

// Written by signal handlers.
std::atomic<bool> leaves{false};
std::atomic<bool> returns{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void noteSignal(int signal) {
  (signal == kLeaveSignal ? leaves : returns) = true;
}

Error failed(const std::string& subject, std::string problem, int errnoValue) {
  Error error = errnoError(subject, std::move(problem), errnoValue,
                           "start pleinair on a console, or as a service with TTYPath=");
  if (errnoValue == EPERM) error.kind = ErrorKind::kPermissionDenied;
  return error;
}

FileDescriptor openTerminal(const std::string& path) {
  return FileDescriptor(::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK));
}

/// The number of the virtual terminal behind a descriptor; 0: it is none.
int numberOf(const FileDescriptor& file) {
  unsigned device = 0;
  if (!file || ::ioctl(file.get(), TIOCGDEV, &device) != 0) return 0;
  const unsigned number = minor(device);
  return major(device) == kTtyMajor && number >= 1 && number <= kMaxTerminal
             ? static_cast<int>(number)
             : 0;
}

class KernelTerminals final : public Terminals {
 public:
  Result<int> take() override {
    Result<int> number = openOurs();
    if (!number) return number;
    const std::string name = "console " + std::to_string(*number);
    vt_mode mode{};
    int drawing = KD_TEXT;
    if (::ioctl(file_.get(), VT_GETMODE, &mode) != 0 ||
        ::ioctl(file_.get(), KDGETMODE, &drawing) != 0) {
      return tl::unexpected(failed(name, "cannot be asked", errno));
    }
    if (mode.mode == VT_PROCESS && drawing == KD_GRAPHICS) {
      return tl::unexpected(Error{.kind = ErrorKind::kBusy,
                                  .subject = name,
                                  .problem = "belongs to a desktop",
                                  .remedy = "end it"});
    }
    handleSignals();
    vt_mode ours{};
    ours.mode = VT_PROCESS;
    ours.relsig = kLeaveSignal;
    ours.acqsig = kReturnSignal;
    if (::ioctl(file_.get(), VT_SETMODE, &ours) != 0) {
      const int error = errno;
      file_.reset();
      return tl::unexpected(failed(name, "cannot be taken", error));
    }
    silence();
    return number;
  }

  void release() override {
    if (!file_) return;
    vt_mode automatic{};
    automatic.mode = VT_AUTO;
    ::ioctl(file_.get(), VT_SETMODE, &automatic);
    if (before_) {
      ::tcsetattr(file_.get(), TCSANOW, &*before_);
      ::tcflush(file_.get(), TCIFLUSH);
      before_.reset();
    }
    file_.reset();
  }

  int front() override {
    vt_stat state{};
    return ::ioctl(file_.get(), VT_GETSTATE, &state) == 0 ? state.v_active : 0;
  }
  void bringToFront(int number) override { ::ioctl(file_.get(), VT_ACTIVATE, number); }

  Request takeRequest() override {
    if (leaves.exchange(false)) return Request::kLeave;
    if (returns.exchange(false)) return Request::kReturn;
    return Request::kNone;
  }
  void allowLeave() override { ::ioctl(file_.get(), VT_RELDISP, 1); }
  void acknowledgeReturn() override { ::ioctl(file_.get(), VT_RELDISP, VT_ACKACQ); }

 private:
  Result<int> openOurs() {
    file_ = openTerminal("/dev/tty");
    if (const int number = numberOf(file_); number != 0) return number;
    file_ = openTerminal("/dev/tty0");
    if (!file_) {
      Error error = failed("/dev/tty0", "cannot open", errno);
      if (errno == ENOENT || errno == ENXIO) error.kind = ErrorKind::kNotFound;
      return tl::unexpected(std::move(error));
    }
    // It stands for the one in front, whichever that is.
    const int number = front();
    const std::string path = "/dev/tty" + std::to_string(number);
    file_ = openTerminal(path);
    if (!file_ || numberOf(file_) != number) {
      return tl::unexpected(failed(path, "cannot open", errno));
    }
    return number;
  }

  /// What is typed for pleinair must not stand on the console afterwards. Signals (Ctrl+C) stay.
  void silence() {
    termios now{};
    // Only what is ours and in the foreground: otherwise the kernel stops the process.
    if (::tcgetpgrp(file_.get()) != ::getpgrp() || ::tcgetattr(file_.get(), &now) != 0) return;
    before_ = now;
    now.c_lflag &= ~static_cast<tcflag_t>(ECHO | ICANON);
    ::tcsetattr(file_.get(), TCSANOW, &now);
  }

  /// For good: a signal that is on its way when the terminal is let go of would end the process.
  static void handleSignals() {
    leaves = false;
    returns = false;
    struct sigaction action {};
    action.sa_handler = noteSignal;
    action.sa_flags = SA_RESTART;
    ::sigaction(kLeaveSignal, &action, nullptr);
    ::sigaction(kReturnSignal, &action, nullptr);
  }

  FileDescriptor file_;
  std::optional<termios> before_;
};

}  // namespace

Terminals& kernelTerminals() {
  static KernelTerminals terminals;
  return terminals;
}

}  // namespace pleinair::hal
