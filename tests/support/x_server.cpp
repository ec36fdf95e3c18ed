#include "tests/support/x_server.h"

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/environment.h"

namespace pleinair::support {
namespace {

constexpr int kPatienceMilliseconds = 60'000;

bool isOnPath(const std::string& program) {
  const char* path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe)
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0) return true;
  }
  return false;
}

[[noreturn]] void become(std::vector<std::string> arguments) {
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDERR_FILENO);
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execvp(argv.front(), argv.data());
  _exit(127);
}

/// Reads one line; nothing if none comes in time.
std::optional<std::string> readLine(int fd) {
  std::string line;
  for (char c = 0;;) {
    pollfd ready{fd, POLLIN, 0};
    if (poll(&ready, 1, kPatienceMilliseconds) <= 0 || read(fd, &c, 1) != 1) return std::nullopt;
    if (c == '\n') return line;
    line += c;
  }
}

/// The required fields of an XWD file's header (X11/XWDFile.h).
struct XwdHeader {
  std::size_t headerBytes, width, height, bitsPerPixel, strideBytes, colours;
};

XwdHeader headerOf(const std::vector<char>& file) {
  const auto word = [&](std::size_t index) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      value = value << 8 | static_cast<std::uint8_t>(file.at(4 * index + i));
    }
    return value;
  };
  return {.headerBytes = word(0),
          .width = word(4),
          .height = word(5),
          .bitsPerPixel = word(11),
          .strideBytes = word(12),
          .colours = word(19)};
}

}  // namespace

std::string XServer::missing() {
  for (const std::string program : {"Xvfb", "xdotool"}) {
    if (!isOnPath(program)) return program + " is not installed";
  }
  return {};
}

XServer::XServer(hal::FrameSize screen) {
  std::array<int, 2> number{};
  if (pipe(number.data()) != 0) throw std::runtime_error("no pipe");
  const std::string size = std::to_string(screen.width) + "x" + std::to_string(screen.height);
  process_ = fork();
  if (process_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);  // a test that crashes ends it, too
    close(number[0]);
    become({"Xvfb", "-displayfd", std::to_string(number[1]), "-screen", "0", size + "x24", "-fbdir",
            folder_.path().string(), "-nolisten", "tcp", "-noreset"});
  }
  close(number[1]);
  const std::optional<std::string> line = readLine(number[0]);
  close(number[0]);
  if (!line) throw std::runtime_error("Xvfb does not start");
  display_ = ":" + *line;
}

XServer::~XServer() {
  if (process_ <= 0) return;
  ::kill(process_, SIGTERM);
  waitpid(process_, nullptr, 0);
}

void XServer::kill() {
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
  process_ = -1;
}

hal::Image XServer::screen() const {
  std::ifstream stream(folder_.path() / "Xvfb_screen0", std::ios::binary);
  const std::vector<char> file{std::istreambuf_iterator<char>(stream), {}};
  const XwdHeader header = headerOf(file);
  if (header.bitsPerPixel != 32) throw std::runtime_error("an XWD file of another depth");
  constexpr std::size_t kColourBytes = 12;
  const std::size_t origin = header.headerBytes + kColourBytes * header.colours;
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8,
                    .size = {static_cast<int>(header.width), static_cast<int>(header.height)}});
  for (std::size_t y = 0; y < header.height; ++y) {
    const auto row = image.row(0, static_cast<int>(y));
    for (std::size_t x = 0; x < header.width; ++x) {
      const std::size_t from = origin + y * header.strideBytes + 4 * x;
      for (std::size_t i = 0; i < 3; ++i) {  // B, G, R in memory
        row[3 * x + i] = static_cast<std::uint8_t>(file.at(from + 2 - i));
      }
    }
  }
  return image;
}

int XServer::xdotool(const std::vector<std::string>& arguments) const {
  const pid_t child = fork();
  if (child == 0) {
    setVariable("DISPLAY", display_.c_str());
    std::vector<std::string> command{"xdotool"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDOUT_FILENO);
    alarm(kPatienceMilliseconds / 1000);  // the call may block for ever
    become(std::move(command));
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void XServer::press(const std::vector<std::string>& keys) const {
  std::vector<std::string> arguments{"key"};
  arguments.insert(arguments.end(), keys.begin(), keys.end());
  if (xdotool(arguments) != 0) throw std::runtime_error("xdotool cannot press keys");
}

bool XServer::waitForTitle(const std::string& pattern) const {
  return xdotool({"search", "--sync", "--onlyvisible", "--name", pattern}) == 0;
}

}  // namespace pleinair::support
