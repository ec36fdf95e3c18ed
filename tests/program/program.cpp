#include "tests/program/program.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/environment.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {
namespace {

constexpr int kPollMilliseconds = 10;

/// Both ends of a pipe, closed at the end.
struct Pipe {
  int read = -1;
  int write = -1;
  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    read = ends[0];
    write = ends[1];
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    closeWrite();
    close(read);
  }
  void closeWrite() {
    if (write >= 0) close(write);
    write = -1;
  }
};

void prepareEnvironment(const std::vector<std::string>& wanted) {
  std::vector<std::string> ours;
  for (char** each = environ; *each != nullptr; ++each) {
    const std::string variable = *each;
    if (variable.starts_with("PLEINAIR_")) ours.push_back(variable.substr(0, variable.find('=')));
  }
  for (const std::string& name : ours) setVariable(name.c_str(), nullptr);
  setVariable("PLEINAIR_CONFIG", "");
  for (const std::string& variable : wanted) {
    const std::size_t equals = variable.find('=');
    if (equals == std::string::npos) {
      setVariable(variable.c_str(), nullptr);
    } else {
      setVariable(variable.substr(0, equals).c_str(), variable.c_str() + equals + 1);
    }
  }
}

void breakPipe(int stream) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0 || dup2(ends[1], stream) < 0) _exit(127);
  close(ends[0]);
}

void spoilStreams(Streams streams) {
  signal(SIGPIPE, SIG_DFL);
  if (streams == Streams::kBrokenPipes || streams == Streams::kBrokenOutput) {
    breakPipe(STDOUT_FILENO);
  }
  if (streams == Streams::kBrokenPipes) breakPipe(STDERR_FILENO);
  if (streams == Streams::kClosed || streams == Streams::kClosedError) close(STDERR_FILENO);
  if (streams != Streams::kClosed) return;
  close(STDIN_FILENO);
  close(STDOUT_FILENO);
}

/// As RestrictAddressFamilies= of systemd does it: such calls of socket() fail.
void forbidInternet() {
  const std::array<sock_filter, 7> lines{{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_socket, 0, 3),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, AF_INET, 2, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, AF_INET6, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EAFNOSUPPORT),
  }};
  const sock_fprog program{.len = lines.size(), .filter = const_cast<sock_filter*>(lines.data())};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
      prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0) {
    _exit(126);
  }
}

void enterRemovedFolder() {
  const TemporaryFolder folder;
  if (chdir(folder.path().c_str()) != 0) _exit(127);
}

[[noreturn]] void becomeProgram(const std::vector<std::string>& arguments,
                                const ProgramLimits& limits, const Pipe& out, const Pipe& error) {
  const int file =
      limits.printsInto.empty() ? out.write : open(limits.printsInto.c_str(), O_WRONLY);
  if (dup2(file, STDOUT_FILENO) < 0) _exit(127);
  dup2(error.write, STDERR_FILENO);
  if (!limits.readsFrom.empty() &&
      dup2(open(limits.readsFrom.c_str(), O_RDONLY), STDIN_FILENO) < 0) {
    _exit(127);
  }
  spoilStreams(limits.streams);
  if (limits.fileBytes > 0) {
    // A write beyond the limit then fails instead of killing.
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{limits.fileBytes, limits.fileBytes};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  prepareEnvironment(limits.environment);
  if (limits.inRemovedFolder) enterRemovedFolder();
  if (limits.addressSpaceBytes > 0 && !isSanitized()) {
    const rlimit limit{limits.addressSpaceBytes, limits.addressSpaceBytes};
    setrlimit(RLIMIT_AS, &limit);
  }
  if (limits.fileDescriptors > 0) {
    const rlimit limit{limits.fileDescriptors, limits.fileDescriptors};
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  if (limits.withoutInternet) forbidInternet();
  std::vector<char*> argv;
  std::string program = limits.program.empty() ? PLEINAIR_PROGRAM : limits.program;
  argv.push_back(program.data());
  std::vector<std::string> copies = arguments;
  for (std::string& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  _exit(127);
}

/// Reads what is there; false at the end of the stream.
bool drain(const pollfd& ready, std::string& text) {
  if ((ready.revents & (POLLIN | POLLHUP)) == 0) return true;
  std::array<char, 4096> bytes{};
  const ssize_t count = read(ready.fd, bytes.data(), bytes.size());
  if (count <= 0) return false;
  text.append(bytes.data(), static_cast<std::size_t>(count));
  return true;
}

void dropCompileNotice(std::string& error) {
  const std::size_t at = error.find("pleinair: info: compiling shaders");
  if (at != std::string::npos) error.erase(at, error.find('\n', at) + 1 - at);
}

void callMeanwhile(const ProgramLimits& limits, pid_t child) {
  try {
    limits.meanwhile(child);
  } catch (const std::exception& error) {
    ADD_FAILURE() << error.what();
    kill(child, SIGTERM);
  }
}

}  // namespace

bool isSanitized() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
  return true;
#else
  return false;
#endif
#else
  return false;
#endif
}

ProgramRun runProgram(const std::vector<std::string>& arguments, const ProgramLimits& limits) {
  Pipe out;
  Pipe error;
  const pid_t child = fork();
  if (child == 0) becomeProgram(arguments, limits, out, error);
  out.closeWrite();
  error.closeWrite();
  std::optional<std::jthread> meanwhile;
  if (limits.meanwhile) meanwhile.emplace([&] { callMeanwhile(limits, child); });
  ProgramRun run;
  bool outOpen = true;
  bool errorOpen = true;
  bool terminated = limits.terminateWhenExists.empty();
  constexpr int kSlowness = 5;  // of sanitizers, beside what limits allow for
  const auto deadline =
      std::chrono::steady_clock::now() + (isSanitized() ? kSlowness : 1) * limits.time;
  while ((outOpen || errorOpen) && std::chrono::steady_clock::now() < deadline) {
    std::array<pollfd, 2> ready{pollfd{outOpen ? out.read : -1, POLLIN, 0},
                                pollfd{errorOpen ? error.read : -1, POLLIN, 0}};
    if (poll(ready.data(), ready.size(), kPollMilliseconds) > 0) {
      outOpen = outOpen && drain(ready[0], run.out);
      errorOpen = errorOpen && drain(ready[1], run.error);
    }
    if (!terminated && std::filesystem::exists(limits.terminateWhenExists)) {
      kill(child, SIGTERM);
      terminated = true;
    }
  }
  if (outOpen || errorOpen) {
    ADD_FAILURE() << "the program hangs";
    kill(child, SIGKILL);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  run.peakMemoryMebibytes = usage.ru_maxrss / 1024;
  if (!limits.keepsCompileNotice) dropCompileNotice(run.error);
  run.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return run;
}

}  // namespace pleinair::support
