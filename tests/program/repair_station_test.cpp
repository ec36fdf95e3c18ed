// The repair station through the program's own door: procedures that are written, checked, drawn
// and carried out, and the records that are left.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hal/media/picture_file.h"
#include "tests/program/program.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/firmware_app/status_server/http_client.h"

namespace pleinair::support {
namespace {

using testing::HasSubstr;
using namespace std::chrono_literals;
using namespace nlohmann::literals;
namespace fs = std::filesystem;

/// A machine may be slow: only what never comes fails.
constexpr auto kPatience = 60s;
const std::string kGearbox =
    (fs::path(PLEINAIR_TESTS_DIR).parent_path() / "config/procedures/gearbox").string();

/// The share of pixels in the colour that is reserved for what is virtual (overlay::kReservedRgb,
/// also shaded), in percent.
double reservedPercent(const hal::Image& image) {
  int count = 0;
  for (int y = 0; y < image.size().height; ++y) {
    const auto row = image.view().row(0, y);
    for (std::size_t i = 0; i + 2 < row.size(); i += 3) {
      const bool isReserved = row[i] > 100 && row[i + 1] < row[i] / 2 && row[i + 2] > row[i] / 2;
      count += isReserved ? 1 : 0;
    }
  }
  return 100.0 * count / static_cast<double>(image.size().pixels());
}

std::string textOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class RepairStation : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories(fs::path(path(name)).parent_path());
    std::ofstream(path(name), std::ios::binary) << text;
  }
  hal::Image picture(const std::string& name) const {
    return hal::orThrow(hal::readPictureRgb(path(name)));
  }

  /// The workbench in bench.mp4, and its scene in bench.toml.
  void recordBench(const std::string& shot, int frames) const {
    const ProgramRun run = runProgram({"record", "--camera", "synthetic:" + shot, "--size",
                                       "640x480", "--frames", std::to_string(frames), "--output",
                                       path("bench.mp4"), "--write-scene", path("bench.toml")});
    ASSERT_EQ(run.status, 0) << run.error;
  }

  /// A procedure with a step of each kind that commands can end.
  void writeProcedure() const {
    write("work/procedure.toml",
          "name = \"work\"\nversion = \"1\"\nlanguages = [\"en\"]\n[model]\n"
          "source = \"builtin:gearbox\"\ncover = \"closed\"\n"
          "[[step]]\nid = \"open\"\nremoves = [\"cover\"]\n"
          "[[step]]\nid = \"look\"\nparts = [\"gear_4\"]\ncheck = \"yes_no\"\n"
          "[[step]]\nid = \"gap\"\nparts = [\"gear_4\"]\n"
          "check = { kind = \"value\", unit = \"mm\", max = 0.2 }\n"
          "[[step]]\nid = \"shut\"\nfits = [\"cover\"]\ncheck = \"photo\"\n");
    write(
        "work/en.md",
        "# Work\n## open: Open it\nSlowly.\n## look: Look\n? Is it clean?\n## gap: Measure\n? Gap\n"
        "## shut: Shut it\nSlowly.\n");
  }

  /// Writes the token of whoever may give commands to "token", readable by its owner alone.
  std::string giveToken() const {
    std::string token = "0123456789abcdef0123456789abcdef";
    write("token", token + "\n");
    chmod(path("token").c_str(), 0600);
    return token;
  }

  TemporaryFolder folder_;
};

TEST_F(RepairStation, AFilmShowsEachStepOverTheMachine) {
  recordBench("still", 6);
  const auto film = [&](const std::string& name, const std::vector<std::string>& more) {
    fs::create_directories(fs::path(path(name)).parent_path());
    std::vector<std::string> arguments{
        "render",      path("bench.mp4"),  "--output",       path(name),
        "--scene",     path("bench.toml"), "--style",        "none",
        "--procedure", kGearbox,           "--step-seconds", "0.1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = runProgram(arguments);
    EXPECT_EQ(run.status, 0) << run.error;
  };
  film("steps/%03d.png", {});
  film("german/%03d.png", {"--set", "procedure.language=de"});
  film("one/%03d.png", {"--step", "cover_off"});
  const auto files = [&](const std::string& name) {
    std::vector<std::string> names;
    for (const auto& each : fs::directory_iterator(path(name))) names.push_back(each.path());
    std::ranges::sort(names);
    return names;
  };
  const std::vector<std::string> steps = files("steps");
  const std::vector<std::string> german = files("german");
  const std::vector<std::string> one = files("one");
  ASSERT_EQ(steps.size(), 6U);
  ASSERT_EQ(one.size(), 6U);
  for (const std::string& each : steps) {
    EXPECT_GT(reservedPercent(hal::orThrow(hal::readPictureRgb(each))), 0.1) << each;
  }
  EXPECT_NE(textOf(steps.front()), textOf(german.front())) << "in German";
  EXPECT_NE(textOf(steps.front()), textOf(steps.back())) << "another step";
  EXPECT_GT(reservedPercent(hal::orThrow(hal::readPictureRgb(one.front()))), 0.3) << "a large part";
}

TEST_F(RepairStation, AStepThatIsNotThereIsRefusedByName) {
  recordBench("still", 1);
  const ProgramRun run =
      runProgram({"render", path("bench.mp4"), "--output", path("out.mp4"), "--scene",
                  path("bench.toml"), "--procedure", kGearbox, "--step", "drian"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.error, testing::AllOf(HasSubstr("drian"), HasSubstr("drain")));
  EXPECT_FALSE(fs::exists(path("out.mp4")));
}

TEST_F(RepairStation, ANewProcedureIsCheckedAndPreviewed) {
  const ProgramRun made = runProgram({"procedure", "new", path("service"), "--model", "builtin:box",
                                      "--language", "en", "--language", "pl"});
  ASSERT_EQ(made.status, 0) << made.error;
  const ProgramRun checked = runProgram({"procedure", "check", path("service"), "--nodes"});
  EXPECT_EQ(checked.status, 1);
  EXPECT_THAT(checked.error, HasSubstr("pl.md: nothing stands below the heading of box"));
  EXPECT_THAT(checked.out, HasSubstr("1 step in en, pl"));
  const ProgramRun drawn = runProgram(
      {"procedure", "preview", path("service"), "--output", path("sheet.png"), "--language", "pl"});
  ASSERT_EQ(drawn.status, 0) << drawn.error;
  EXPECT_GT(reservedPercent(picture("sheet.png")), 0.5);
}

TEST_F(RepairStation, TheSheetOfNodesShowsWhichIsWhich) {
  write("two/two.obj",
        "o plate\nv 0 0 0\nv 90 0 0\nv 90 0 60\nv 0 0 60\nf 1 4 3 2\n"
        "o pin\nv 40 0 30\nv 50 0 30\nv 45 50 30\nf 5 6 7\n");
  const ProgramRun made = runProgram(
      {"procedure", "new", path("two"), "--model", path("two/two.obj"), "--units", "mm"});
  ASSERT_EQ(made.status, 0) << made.error;
  EXPECT_THAT(made.out, HasSubstr("--nodes"));
  const ProgramRun drawn =
      runProgram({"procedure", "preview", path("two"), "--nodes", "--output", path("nodes.png")});
  ASSERT_EQ(drawn.status, 0) << drawn.error;
  EXPECT_THAT(drawn.out, HasSubstr("drew 2 nodes"));
  EXPECT_GT(reservedPercent(picture("nodes.png")), 0.5);
}

TEST_F(RepairStation, ARenamedNodeIsNamedWithFileAndLine) {
  writeProcedure();
  std::string toml = textOf(path("work/procedure.toml"));
  toml.replace(toml.find("\"cover\""), 7, "\"covr\"");
  write("work/procedure.toml", toml);
  const ProgramRun run = runProgram({"procedure", "check", path("work")});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.error, testing::AllOf(HasSubstr("procedure.toml:9:"), HasSubstr("\"cover\"")));
}

TEST_F(RepairStation, ATemplateIsTakenFromARecording) {
  recordBench("still", 3);
  writeProcedure();
  const ProgramRun unnamed =
      runProgram({"procedure", "template", path("work"), "shut.png", "--scene", path("bench.toml"),
                  "--input", path("bench.mp4")});
  EXPECT_EQ(unnamed.status, 2) << "there are two models";
  EXPECT_THAT(unnamed.error, testing::AllOf(HasSubstr("gearbox"), HasSubstr("pinion")));
  const ProgramRun run =
      runProgram({"procedure", "template", path("work"), "shut.png", "--scene", path("bench.toml"),
                  "--input", path("bench.mp4"), "--model", "gearbox"});
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(picture("work/shut.png").size(), (hal::FrameSize{640, 480}));
  std::string toml = textOf(path("work/procedure.toml"));
  const std::string photo = "check = \"photo\"";
  toml.replace(
      toml.find(photo), photo.size(),
      "check = { kind = \"compare\", template = \"shut.png\" }\ngoto = { fail = \"open\" }");
  write("work/procedure.toml", toml);
  const ProgramRun checked = runProgram({"procedure", "check", path("work")});
  EXPECT_EQ(checked.status, 0) << checked.error;
  EXPECT_THAT(checked.out, HasSubstr("shut.toml"));
}

TEST_F(RepairStation, InputsAreListedAndLearntIntoANewFileOnly) {
  const ProgramRun listed = runProgram({"inputs"});
  EXPECT_EQ(listed.status, 0) << listed.error;
  EXPECT_NE(listed.out, "");
  write("inputs.toml", "[cards]\n");
  const ProgramRun refused = runProgram({"inputs", "--learn", path("inputs.toml")});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.error, HasSubstr("exists already"));
  EXPECT_EQ(textOf(path("inputs.toml")), "[cards]\n");
}

TEST_F(RepairStation, InputsAreWatchedUntilASignal) {
  ProgramLimits limits;
  limits.printsInto = path("out.txt");
  write("out.txt", "");
  limits.meanwhile = [&](pid_t program) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (textOf(path("out.txt")).empty() && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(10ms);
    }
    kill(program, SIGINT);
  };
  EXPECT_EQ(runProgram({"inputs", "--watch"}, limits).status, 0);
}

/// A port of the loopback that nothing listens at.
std::string freeAddress() {
  const int taken = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{
      .sin_family = AF_INET, .sin_port = 0, .sin_addr = {htonl(INADDR_LOOPBACK)}, .sin_zero = {}};
  socklen_t length = sizeof address;
  if (bind(taken, reinterpret_cast<sockaddr*>(&address), length) != 0) {
    throw std::runtime_error("no port is free");
  }
  getsockname(taken, reinterpret_cast<sockaddr*>(&address), &length);
  close(taken);
  return "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
}

/// Somebody who steps through a procedure by HTTP.
class Operator {
 public:
  Operator(std::string address, std::string token)
      : address_(std::move(address)), token_(std::move(token)) {}

  nlohmann::json status() const {
    try {
      const std::string reply = app::HttpClient::request(address_, "GET /status");
      return nlohmann::json::parse(reply.substr(reply.find("\r\n\r\n") + 4), nullptr, false);
    } catch (const std::runtime_error&) {
      return {};  // it does not listen yet
    }
  }
  /// Waits until the status has `value` at `key`; false: it never does.
  bool awaits(const std::string& key, const std::string& value) const {
    return until([&](const nlohmann::json& now) { return now.value(key, "") == value; });
  }
  bool awaitsPainting() const {
    return until([](const nlohmann::json& now) {
      return now.value("/painting/painted"_json_pointer, 0) > 0;
    });
  }
  /// The first line of the reply.
  std::string say(const std::string& command) const {
    app::HttpClient client(address_);
    client.send("POST /procedure HTTP/1.1\r\nHost: here\r\nAuthorization: Bearer " + token_ +
                "\r\nContent-Length: " + std::to_string(command.size()) + "\r\n\r\n" + command);
    const std::string reply = client.receiveAll();
    return reply.substr(0, reply.find("\r\n"));
  }

 private:
  template <class Condition>
  bool until(const Condition& condition) const {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < deadline) {
      const nlohmann::json now = status();
      if (now.is_object() && condition(now)) return true;
      std::this_thread::sleep_for(20ms);
    }
    return false;
  }

  std::string address_;
  std::string token_;
};

TEST_F(RepairStation, AProcedureIsCarriedOutSignedOffCheckedAndExported) {
  recordBench("still", 10);
  writeProcedure();
  fs::create_directory(path("records"));
  const std::string token = giveToken();
  const std::string address = freeAddress();
  std::string record;
  ProgramLimits limits;
  limits.meanwhile = [&](pid_t program) {
    const Operator jo(address, token);
    EXPECT_TRUE(jo.awaits("procedure_step", "open"));
    // A photo needs a picture, and painting takes a while to begin.
    EXPECT_TRUE(jo.awaitsPainting());
    EXPECT_THAT(Operator(address, "wrong").say("next"), HasSubstr("401"));
    EXPECT_THAT(jo.say("dance"), HasSubstr("400"));
    for (const auto& [command, step] :
         {std::pair("next", "look"), {"yes", "gap"}, {"value 0.15", "shut"}, {"photo", "end"}}) {
      EXPECT_THAT(jo.say(command), HasSubstr("202"));
      EXPECT_TRUE(jo.awaits("procedure_step", step)) << command << ": " << jo.status().dump();
    }
    record = jo.status().value("procedure_record", "");
    EXPECT_THAT(jo.say("sign_off"), HasSubstr("202"));
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (textOf(record).find("signed_off") == std::string::npos &&
           std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(20ms);
    }
    kill(program, SIGTERM);
  };
  for (const char* variable : {"SDL_VIDEODRIVER", "WAYLAND_DISPLAY", "DISPLAY"}) {
    limits.environment.emplace_back(variable);
  }
  const ProgramRun live =
      runProgram({"run", "--camera", path("bench.mp4"), "--output", path("out.mp4"), "--scene",
                  path("bench.toml"), "--style", "none", "--procedure", path("work"), "--set",
                  "procedure.records=" + path("records"), "--set", "procedure.operator=Jo", "--set",
                  "status.listen=" + address, "--set", "status.token_file=" + path("token")},
                 limits);
  ASSERT_EQ(live.status, 0) << live.error;
  ASSERT_NE(record, "");

  const ProgramRun checked = runProgram(
      {"record-check", record, "--report", path("records/work.html"), "--procedure", path("work")});
  EXPECT_EQ(checked.status, 0) << checked.error;
  EXPECT_THAT(checked.out, HasSubstr("unchanged and signed off as completed"));
  EXPECT_THAT(textOf(path("records/work.html")),
              testing::AllOf(HasSubstr("1. Open it"), HasSubstr("0.15"), HasSubstr("Jo")));
  const ProgramRun exported = runProgram(
      {"record-export", record, "--output", path("work.zip"), "--procedure", path("work")});
  EXPECT_EQ(exported.status, 0) << exported.error;
  const std::string zip = textOf(path("work.zip"));
  EXPECT_TRUE(zip.starts_with("PK"));
  for (const char* name : {"report.html", ".jsonl", ".png", "procedure/procedure.toml"}) {
    EXPECT_THAT(zip, HasSubstr(name));
  }

  std::string changed = textOf(record);
  changed.replace(changed.find("0.15"), 4, "0.25");
  std::ofstream(record, std::ios::binary) << changed;
  const ProgramRun found = runProgram({"record-check", record});
  EXPECT_EQ(found.status, 1);
  EXPECT_THAT(found.error, testing::ContainsRegex(R"(\.jsonl:[0-9]+: )"));
}

TEST_F(RepairStation, StepsWhileTheCameraIsAwaited) {
  writeProcedure();
  fs::create_directory(path("records"));
  const std::string token = giveToken();
  const std::string address = freeAddress();
  ProgramLimits limits;
  limits.meanwhile = [&](pid_t program) {
    const Operator jo(address, token);
    EXPECT_TRUE(jo.awaits("procedure_step", "open"));
    for (const auto& [command, step] : {std::pair("next", "look"), {"yes", "gap"}}) {
      EXPECT_THAT(jo.say(command), HasSubstr("202"));
      EXPECT_TRUE(jo.awaits("procedure_step", step)) << command << ": " << jo.status().dump();
    }
    kill(program, SIGTERM);
  };
  for (const char* variable : {"SDL_VIDEODRIVER", "WAYLAND_DISPLAY", "DISPLAY"}) {
    limits.environment.emplace_back(variable);
  }
  const ProgramRun live =
      runProgram({"run", "--camera", "v4l2:/dev/video987", "--set", "camera.wait=true", "--output",
                  path("out.mp4"), "--style", "none", "--procedure", path("work"), "--set",
                  "procedure.records=" + path("records"), "--set", "status.listen=" + address,
                  "--set", "status.token_file=" + path("token")},
                 limits);
  EXPECT_EQ(live.status, 0) << live.error;
  EXPECT_THAT(live.error, HasSubstr("step gap: "));
}

TEST_F(RepairStation, AStartThatIsRefusedLeavesNoRecord) {
  recordBench("still", 1);
  writeProcedure();
  fs::create_directory(path("records"));
  const ProgramRun run =
      runProgram({"run", "--camera", path("bench.mp4"), "--output", path("out.mp4"), "--scene",
                  path("bench.toml"), "--procedure", path("work"), "--set",
                  "procedure.machine=lathe", "--set", "procedure.records=" + path("records")});
  EXPECT_EQ(run.status, 2) << run.error;
  EXPECT_THAT(run.error, HasSubstr("--set procedure.machine="));
  EXPECT_TRUE(fs::is_empty(path("records")));
}

}  // namespace
}  // namespace pleinair::support
