#include "pipeline/gpu/frames/trial_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <string_view>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pleinair::gpu {
namespace {

/// A driver that is loaded and compiles a program, on a machine that emulates another.
constexpr hal::Duration kPatience = std::chrono::seconds(60);

hal::Error failed(std::string problem) {
  return {.kind = hal::ErrorKind::kUnsupported,
          .subject = "GPU",
          .problem = std::move(problem),
          .remedy = {}};
}

}  // namespace

std::optional<std::vector<std::uint64_t>> TrialProcess::numbersOf(int argc,
                                                                  const char* const* argv) {
  std::vector<std::uint64_t> numbers;
  numbers.reserve(static_cast<std::size_t>(std::max(argc, 0)));
  for (int i = 2; i < argc; ++i) {
    const std::string_view text(argv[i]);
    std::uint64_t number = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
    if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return std::nullopt;
    numbers.push_back(number);
  }
  return numbers;
}

TrialProcess::TrialProcess(std::vector<std::string> arguments, std::span<const int> descriptors,
                           std::string task, const hal::Clock& clock)
    : task_(std::move(task)), clock_(clock), began_(clock.now()) {
  std::vector<char*> argv;
  for (std::string& each : arguments) argv.push_back(each.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  // The driver's warnings were said once.
  for (const int each : {STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&files, each, "/dev/null", O_WRONLY, 0);
  }
  // Copies that the child's numbers cannot overwrite first.
  std::vector<int> copies;
  for (const int each : descriptors) {
    constexpr int kHigh = 64;
    copies.push_back(::fcntl(each, F_DUPFD_CLOEXEC, kHigh));
    posix_spawn_file_actions_adddup2(&files, copies.back(),
                                     kFirstDescriptor + static_cast<int>(copies.size()) - 1);
  }
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // Signals that end the program reach the child through its end, not by themselves.
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  pid_t process = -1;
  const int error =
      ::posix_spawn(&process, "/proc/self/exe", &files, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  for (const int each : copies) ::close(each);
  if (error == 0) {
    process_ = process;
  } else {
    result_ = tl::unexpected(failed("cannot be tried: no process can be started"));
  }
}

TrialProcess::~TrialProcess() {
  if (process_ < 0) return;
  ::kill(process_, SIGKILL);
  if (::waitpid(process_, nullptr, WNOHANG) != 0) return;
  // A driver call that cannot be interrupted holds the process: it is not waited for here.
  std::thread([process = process_] { ::waitpid(process, nullptr, 0); }).detach();
}

/// How it has ended.
hal::Result<int> TrialProcess::resultOf(int status) const {
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  return tl::unexpected(failed(fmt::format("its driver crashes where it has to {} (signal {})",
                                           task_, WIFSIGNALED(status) ? WTERMSIG(status) : 0)));
}

std::optional<hal::Result<int>> TrialProcess::poll() {
  if (result_) return result_;
  int status = 0;
  const pid_t ended = ::waitpid(process_, &status, WNOHANG);
  if (ended == process_) {
    process_ = -1;
    result_ = resultOf(status);
  } else if (ended < 0 && errno != EINTR) {
    process_ = -1;
    result_ = tl::unexpected(failed("cannot be tried: its process is lost"));
  } else if (clock_.now() - began_ > kPatience) {
    result_ = tl::unexpected(failed("takes too long to " + task_));
  }
  return result_;
}

}  // namespace pleinair::gpu
