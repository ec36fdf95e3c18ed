#include "firmware_app/service_manager/passed_socket.h"

#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pleinair::app {
namespace {

/// Passing takes the descriptors 3 and 4, which a child of its own has for it.
template <class Check>
void inChild(Check check) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) _exit(check());
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

/// Puts a file that does not listen at 3, and a socket that does at 4.
void pass(pid_t process, const char* count) {
  const int listening = socket(AF_INET, SOCK_STREAM, 0);
  listen(listening, 1);
  const int other = open("/dev/null", O_RDONLY);
  const int high = fcntl(listening, F_DUPFD, 20);
  dup2(other, 3);
  dup2(high, 4);
  setenv("LISTEN_PID", std::to_string(process).c_str(), 1);
  setenv("LISTEN_FDS", count, 1);
  setenv("LISTEN_FDNAMES", "status", 1);
}

TEST(PassedSocket, IsTheOneThatListens) {
  inChild([] {
    pass(getpid(), "2");
    const hal::FileDescriptor taken = takePassedSocket();
    if (taken.get() != 4) return 1;
    if ((fcntl(4, F_GETFD) & FD_CLOEXEC) == 0) return 2;
    if (fcntl(3, F_GETFD) >= 0) return 3;  // the other one is closed
    if (std::getenv("LISTEN_FDS") != nullptr) return 4;
    return takePassedSocket() ? 5 : 0;  // once only
  });
}

TEST(PassedSocket, IsNotAnotherProcesss) {
  inChild([] {
    pass(getppid(), "2");
    if (takePassedSocket()) return 1;
    return fcntl(4, F_GETFD) >= 0 ? 0 : 2;  // and nothing is closed
  });
}

TEST(PassedSocket, NeedsANumber) {
  for (const char* count : {"", "0", "-1", "two", "1000000"}) {
    inChild([count] {
      pass(getpid(), count);
      return takePassedSocket() ? 1 : 0;
    });
  }
}

}  // namespace
}  // namespace pleinair::app
