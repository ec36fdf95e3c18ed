#include "firmware_app/status_server/status_server.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iterator>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/un.h>

#include "tests/support/temporary_folder.h"
#include "tests/unit/firmware_app/status_server/http_client.h"

namespace pleinair::app {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::ptrdiff_t entriesOf(const char* folder) {
  const std::filesystem::directory_iterator first(folder);
  return std::distance(first, std::filesystem::directory_iterator());
}

class StatusServerTest : public testing::Test {
 protected:
  std::unique_ptr<StatusServer> start(const std::string& listen = "127.0.0.1:0") {
    return startStatusServer(listen, {.page = [] { return std::string("<!DOCTYPE html>"); },
                                      .picture = [this] { return picture_; },
                                      .json = [this] { return json_; },
                                      .metrics = [this] { return metrics_; },
                                      .healthy = [this] { return healthy_.load(); }});
  }

  /// One that takes "next" and values.
  std::unique_ptr<StatusServer> startCommanded() {
    return startStatusServer(
        "127.0.0.1:0",
        {.page = [] { return std::string(); },
         .picture = {},
         .json = {},
         .metrics = {},
         .healthy = [] { return true; },
         .commands = {.token = kToken, .take = [this](std::string_view text) -> hal::Result<void> {
                        if (text == "nxt") {
                          return tl::unexpected(hal::Error{.subject = "not this one"});
                        }
                        if (text == "busy") {
                          return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kBusy});
                        }
                        taken_.emplace_back(text);
                        return {};
                      }}});
  }
  static std::string post(const StatusServer& server, const std::string& header,
                          const std::string& body) {
    HttpClient client(server.address());
    client.send(
        fmt::format("POST /procedure HTTP/1.1\r\nHost: x\r\n{}\r\nContent-Length: {}"
                    "\r\n\r\n{}",
                    header, body.size(), body));
    return client.receiveAll();
  }

  static inline const std::string kToken = "0123456789abcdef";
  std::vector<std::string> taken_;  ///< by the server's thread, before it answers
  std::string picture_;
  std::string json_ = R"({"shown":12})";
  std::string metrics_ = "# TYPE pleinair_shown_total counter\npleinair_shown_total 12\n";
  std::atomic<bool> healthy_ = true;
};

TEST_F(StatusServerTest, ServesItsPages) {
  const auto server = start();
  const std::string status = HttpClient::request(server->address(), "GET /status");
  EXPECT_THAT(status, AllOf(StartsWith("HTTP/1.1 200 "), HasSubstr("application/json"),
                            HasSubstr("\r\n\r\n" + json_)));
  const std::string metrics = HttpClient::request(server->address(), "GET /metrics");
  EXPECT_THAT(metrics, AllOf(StartsWith("HTTP/1.1 200 "), HasSubstr("version=0.0.4"),
                             HasSubstr("\r\n\r\n" + metrics_)));
  EXPECT_THAT(HttpClient::request(server->address(), "GET /status?x=1"), HasSubstr(json_));
}

TEST_F(StatusServerTest, ServesAtASocketThatWasPassed) {
  hal::FileDescriptor listening(socket(AF_INET, SOCK_STREAM, 0));
  ASSERT_EQ(listen(listening.get(), 4), 0) << "at a free port of all addresses";
  const auto server = startStatusServer(
      std::move(listening), {.json = [this] { return json_; }, .metrics = {}, .healthy = {}});
  EXPECT_THAT(server->address(), StartsWith("0.0.0.0:"));
  EXPECT_THAT(HttpClient::request(server->address(), "GET /status"), HasSubstr(json_));
}

TEST_F(StatusServerTest, ServesAtALocalSocketThatWasPassed) {
  const support::TemporaryFolder folder;
  const std::string path = (folder.path() / "status").string();
  sockaddr_un here{};
  here.sun_family = AF_UNIX;
  std::ranges::copy(path, std::begin(here.sun_path));
  hal::FileDescriptor listening(socket(AF_UNIX, SOCK_STREAM, 0));
  ASSERT_EQ(bind(listening.get(), reinterpret_cast<const sockaddr*>(&here), sizeof here), 0);
  ASSERT_EQ(listen(listening.get(), 4), 0);
  const auto server = startStatusServer(
      std::move(listening), {.json = [this] { return json_; }, .metrics = {}, .healthy = {}});
  EXPECT_EQ(server->address(), "unix:" + path);
  const hal::FileDescriptor client(socket(AF_UNIX, SOCK_STREAM, 0));
  ASSERT_EQ(connect(client.get(), reinterpret_cast<const sockaddr*>(&here), sizeof here), 0);
  const std::string request = "GET /status HTTP/1.1\r\nHost: here\r\n\r\n";
  ASSERT_EQ(write(client.get(), request.data(), request.size()),
            static_cast<ssize_t>(request.size()));
  std::string answer(4096, '\0');
  answer.resize(static_cast<std::size_t>(recv(client.get(), answer.data(), answer.size(), 0)));
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 "));
}

TEST_F(StatusServerTest, ServesAPageForPeopleWithAPicture) {
  const auto server = start();
  EXPECT_THAT(HttpClient::request(server->address(), "GET /"),
              AllOf(StartsWith("HTTP/1.1 200 "), HasSubstr("text/html; charset=utf-8"),
                    HasSubstr("\r\n\r\n<!DOCTYPE html>")));
  EXPECT_THAT(HttpClient::request(server->address(), "GET /painting.jpg"),
              StartsWith("HTTP/1.1 404 "));
  picture_ = std::string("\xFF\xD8\0\xD9", 4);
  EXPECT_THAT(HttpClient::request(server->address(), "GET /painting.jpg"),
              AllOf(StartsWith("HTTP/1.1 200 "), HasSubstr("image/jpeg"),
                    HasSubstr("\r\n\r\n" + picture_)));
}

TEST_F(StatusServerTest, AnswersHeadWithoutTheBody) {
  const auto server = start();
  EXPECT_THAT(HttpClient::request(server->address(), "HEAD /status"),
              AllOf(StartsWith("HTTP/1.1 200 "), Not(HasSubstr("shown"))));
}

TEST_F(StatusServerTest, TellsItsHealth) {
  const auto server = start();
  EXPECT_THAT(HttpClient::request(server->address(), "GET /healthz"), StartsWith("HTTP/1.1 200 "));
  healthy_ = false;
  EXPECT_THAT(HttpClient::request(server->address(), "GET /healthz"), StartsWith("HTTP/1.1 503 "));
}

TEST_F(StatusServerTest, TakesCommandsFromThisMachineWithTheToken) {
  const auto server = startCommanded();
  EXPECT_THAT(post(*server, "Authorization: Bearer " + kToken, "next"),
              StartsWith("HTTP/1.1 202 "));
  EXPECT_THAT(taken_, ElementsAre("next"));
  EXPECT_THAT(post(*server, "Authorization: Bearer " + kToken, "nxt"),
              AllOf(StartsWith("HTTP/1.1 400 "), HasSubstr("not this one")));
  EXPECT_THAT(post(*server, "Authorization: Bearer " + kToken, "busy"),
              StartsWith("HTTP/1.1 503 "));
  EXPECT_THAT(taken_, ElementsAre("next"));
}

TEST_F(StatusServerTest, RefusesCommandsWithoutTheTokenAndOfForeignPages) {
  const auto server = startCommanded();
  for (const std::string header :
       {"X: y", "Authorization: Bearer", "Authorization: Bearer x", "Authorization: Basic abc",
        "Authorization: bearer 0123456789abcdef"}) {
    EXPECT_THAT(post(*server, header, "next"), StartsWith("HTTP/1.1 401 ")) << header;
  }
  const std::string right = "Authorization: Bearer " + kToken;
  EXPECT_THAT(post(*server, right + "0", "next"), StartsWith("HTTP/1.1 401 "));
  EXPECT_THAT(post(*server, right + "\r\nOrigin: http://127.0.0.1", "next"),
              StartsWith("HTTP/1.1 403 "));
  EXPECT_THAT(post(*server, right, std::string(300, 'n')), StartsWith("HTTP/1.1 413 "));
  EXPECT_THAT(HttpClient::request(server->address(), "GET /procedure"),
              AllOf(StartsWith("HTTP/1.1 405 "), HasSubstr("Allow: POST")));
  EXPECT_THAT(taken_, testing::IsEmpty());
}

TEST_F(StatusServerTest, ABodyInPiecesIsOneCommandAndAnAbortedOneNone) {
  const auto server = startCommanded();
  {
    HttpClient client(server->address());
    client.send("POST /procedure HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer " + kToken +
                "\r\nContent-Length: 9\r\n\r\nval");
    client.send("ue 1.5");
    EXPECT_THAT(client.receiveAll(), StartsWith("HTTP/1.1 202 "));
  }
  {
    HttpClient client(server->address());
    client.send("POST /procedure HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer " + kToken +
                "\r\nContent-Length: 9\r\n\r\nnext");
  }
  EXPECT_THAT(HttpClient::request(server->address(), "GET /healthz"), HasSubstr("200 OK"));
  EXPECT_THAT(taken_, ElementsAre("value 1.5"));
}

TEST_F(StatusServerTest, WithoutATokenThereAreNoCommands) {
  const auto server = start();
  EXPECT_THAT(post(*server, "Authorization: Bearer ", "next"), StartsWith("HTTP/1.1 404 "));
}

TEST_F(StatusServerTest, RefusesOtherPagesAndMethods) {
  const auto server = start();
  for (const char* line : {"GET /x", "GET /status/", "GET /../etc/passwd", "POST /x"}) {
    EXPECT_THAT(HttpClient::request(server->address(), line), StartsWith("HTTP/1.1 404 ")) << line;
  }
  for (const char* line : {"POST /status", "PUT /metrics", "DELETE /healthz", "TRACE /status"}) {
    EXPECT_THAT(HttpClient::request(server->address(), line),
                AllOf(StartsWith("HTTP/1.1 405 "), HasSubstr("Allow: GET, HEAD")))
        << line;
  }
}

TEST_F(StatusServerTest, AnswersAPageThatThrows) {
  const auto server = startStatusServer(
      "127.0.0.1:0", {.page = [] { return std::string(); },
                      .picture = [] { return std::string(); },
                      .json = []() -> std::string { throw std::runtime_error("no memory"); },
                      .metrics = [] { return std::string(); },
                      .healthy = [] { return true; }});
  EXPECT_THAT(HttpClient::request(server->address(), "GET /status"), StartsWith("HTTP/1.1 500 "));
  EXPECT_THAT(HttpClient::request(server->address(), "GET /metrics"), StartsWith("HTTP/1.1 200 "));
}

TEST_F(StatusServerTest, ReadsNoBody) {
  const auto server = start();
  HttpClient client(server->address());
  client.send("POST /status HTTP/1.1\r\nHost: x\r\nContent-Length: 999999999999\r\n\r\n");
  EXPECT_THAT(client.receiveAll(), StartsWith("HTTP/1.1 405 "));
}

TEST_F(StatusServerTest, EndsRequestsWithoutEnd) {
  const auto server = start();
  for (const char* part : {"GET /", "GET /status HTTP/1.1\r\nX: "}) {
    HttpClient client(server->address());
    client.send(part);
    const std::string more(1000, 'x');
    int sent = 0;
    while (sent < 1000 && client.send(more)) ++sent;
    EXPECT_THAT(client.receiveAll(), Not(HasSubstr("200 OK")));
  }
  EXPECT_THAT(HttpClient::request(server->address(), "GET /healthz"), HasSubstr("200 OK"));
}

TEST_F(StatusServerTest, OutlivesRubbish) {
  const auto server = start();
  for (const std::string& text :
       {std::string("\0\0\0\0\r\n\r\n", 8), std::string("\x16\x03\x01\x02\x00\x01", 6),
        std::string("GET\r\n\r\n"), std::string("\r\n\r\n\r\n"),
        std::string("GET /status HTTP/9.9\r\n\r\n"), std::string(5000, '\n')}) {
    HttpClient client(server->address());
    client.send(text);
  }
  EXPECT_THAT(HttpClient::request(server->address(), "GET /status"), HasSubstr(json_));
}

TEST_F(StatusServerTest, SlowClientsKeepNobodyOut) {
  const auto server = start();
  const std::ptrdiff_t before = entriesOf("/proc/self/fd");
  std::vector<std::unique_ptr<HttpClient>> slow;
  for (int i = 0; i < 60; ++i) {
    slow.push_back(std::make_unique<HttpClient>(server->address()));
    slow.back()->send("GET /status HT");  // and never the rest
    EXPECT_THAT(HttpClient::request(server->address(), "GET /status"), HasSubstr(json_)) << i;
  }
  const std::ptrdiff_t ours = 60;
  EXPECT_LE(entriesOf("/proc/self/fd") - before - ours, 24) << "the server's end of them";
}

TEST_F(StatusServerTest, StopsAtOnceWhateverClientsDo) {
  json_ = std::string(20'000'000, 'x');
  auto server = start();
  HttpClient silent(server->address());
  HttpClient half(server->address());
  half.send("GET /status HT");
  HttpClient neverReads(server->address());
  neverReads.send("GET /status HTTP/1.1\r\nHost: x\r\n\r\n");
  EXPECT_THAT(HttpClient::request(server->address(), "GET /healthz"), HasSubstr("200 OK"));
  const auto begin = std::chrono::steady_clock::now();
  server.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
}

TEST_F(StatusServerTest, LeavesNothingBehindIn100Cycles) {
  start();
  const std::ptrdiff_t descriptors = entriesOf("/proc/self/fd");
  const std::ptrdiff_t threads = entriesOf("/proc/self/task");
  for (int i = 0; i < 100; ++i) {
    const auto server = start();
    if (i % 10 == 0) {
      EXPECT_THAT(HttpClient::request(server->address(), "GET /status"), HasSubstr(json_));
    }
  }
  EXPECT_EQ(entriesOf("/proc/self/fd"), descriptors);
  EXPECT_EQ(entriesOf("/proc/self/task"), threads);
}

TEST_F(StatusServerTest, OffIsNone) {
  EXPECT_EQ(start("off"), nullptr);
}

TEST_F(StatusServerTest, SaysWhyItCannotListen) {
  const auto server = start();
  EXPECT_THAT(server->address(), Not(HasSubstr(":0"))) << "the port that it was given";
  struct Case {
    std::string listen;
    hal::ErrorKind kind;
    std::string text;
  };
  for (const Case& each :
       {Case{server->address(), hal::ErrorKind::kBusy, "give another port"},
        Case{"192.0.2.1:9117", hal::ErrorKind::kInvalidArgument, "an address of this machine"},
        Case{"here", hal::ErrorKind::kInvalidArgument, "ADDRESS:PORT"}}) {
    try {
      start(each.listen);
      ADD_FAILURE() << each.listen;
    } catch (const hal::Failure& error) {
      EXPECT_EQ(error.error().kind, each.kind) << each.listen;
      EXPECT_THAT(error.what(), AllOf(HasSubstr("status.listen"), HasSubstr(each.text)));
    }
  }
}

}  // namespace
}  // namespace pleinair::app
