// The shipped units, judged by systemd itself: they are well-formed, and expose little.
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/support/temporary_folder.h"

namespace pleinair {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kUnits = PLEINAIR_UNITS;
const fs::path kDropIns = PLEINAIR_DROP_INS;

struct Answer {
  int status = 0;
  std::string text;
};

Answer ask(const std::string& command) {
  FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  Answer answer;
  std::array<char, 4096> part{};
  for (std::size_t size = 0; (size = fread(part.data(), 1, part.size(), pipe)) > 0;) {
    answer.text.append(part.data(), size);
  }
  answer.status = WEXITSTATUS(pclose(pipe));
  return answer;
}

std::string textOf(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

class Units : public testing::Test {
 protected:
  void SetUp() override {
    if (ask("systemd-analyze --version").status != 0) {
      GTEST_SKIP() << "there is no systemd-analyze (package systemd)";
    }
    for (const auto& each : fs::directory_iterator(kUnits)) {
      fs::copy_file(each.path(), folder_.path() / each.path().filename());
    }
  }

  /// A template is judged as an instance of it.
  static std::string instanceOf(std::string name) {
    const std::size_t at = name.find("@.");
    return at == std::string::npos ? name : name.insert(at + 1, "pleinair-kiosk");
  }
  Answer analyze(const std::string& verb, const std::string& unit) const {
    const std::string folder = folder_.path().string();
    return ask("SYSTEMD_UNIT_PATH=" + folder + ": systemd-analyze --no-pager --man=no " + verb +
               " '" + folder + "/" + instanceOf(unit) + "'");
  }
  double exposureOf(const std::string& unit) const {
    const Answer answer = analyze("security --offline=true", unit);
    static const std::regex kLevel(R"(exposure level for [^:]*: ([\d.]+))");
    std::smatch match;
    if (!std::regex_search(answer.text, match, kLevel)) {
      ADD_FAILURE() << unit << ": " << answer.text;
      return 10;
    }
    return std::stod(match[1]);
  }
  void addDropIn(const std::string& service, const std::string& name) const {
    const fs::path place = folder_.path() / (service + ".d");
    fs::create_directories(place);
    fs::copy_file(kDropIns / name, place / name);
  }
  std::vector<std::string> services() const {
    std::vector<std::string> names;
    for (const auto& each : fs::directory_iterator(folder_.path())) {
      if (each.path().extension() == ".service") names.push_back(each.path().filename());
    }
    return names;
  }

  support::TemporaryFolder folder_;
};

TEST_F(Units, AreWellFormed) {
  int count = 0;
  for (const auto& each : fs::directory_iterator(kUnits)) {
    const Answer answer = analyze("verify", each.path().filename());
    EXPECT_EQ(answer.status, 0) << answer.text;
    EXPECT_EQ(answer.text, "") << each.path();
    ++count;
  }
  EXPECT_GE(count, 6);
}

TEST_F(Units, AreRefusedWhereTheyAreNot) {
  const fs::path kiosk = folder_.path() / "pleinair-kiosk.service";
  std::ofstream(kiosk, std::ios::app) << "\n[Service]\nExecStartPre=/nowhere/program\nTypo=yes\n";
  const Answer answer = analyze("verify", "pleinair-kiosk.service");
  EXPECT_NE(answer.status, 0);
  EXPECT_THAT(answer.text, HasSubstr("/nowhere/program"));
  EXPECT_THAT(answer.text, HasSubstr("Typo"));
}

TEST_F(Units, ExposeLittle) {
  for (const std::string& each : services()) {
    const bool opensDevices =
        textOf(folder_.path() / each).find("\nDeviceAllow=") != std::string::npos;
    EXPECT_LE(exposureOf(each), opensDevices ? 1.0 : 0.5) << each;
  }
  EXPECT_GE(services().size(), 3u);
}

/// The value of the first such line: "Where" of "Where=/media".
std::string valueIn(const std::string& text, const std::string& key) {
  const std::size_t at = text.find("\n" + key + "=");
  if (at == std::string::npos) return {};
  const std::size_t begin = at + key.size() + 2;
  return text.substr(begin, text.find('\n', begin) - begin);
}

TEST_F(Units, LookForTheSetUpWhereItsPartitionIsMountedReadOnly) {
  const std::string mount = textOf(folder_.path() / "media-pleinair.mount");
  const std::string where = valueIn(mount, "Where");
  EXPECT_EQ(where, "/media/pleinair") << "as the unit's name says";
  const std::string options = "," + valueIn(mount, "Options") + ",";
  for (const char* option : {",ro,", ",nosuid,", ",nodev,", ",noexec,"}) {
    EXPECT_THAT(options, HasSubstr(option));
  }
  for (const char* service : {"pleinair-kiosk.service", "pleinair-repair-station.service"}) {
    const std::string text = textOf(folder_.path() / service);
    EXPECT_THAT(valueIn(text, "ExecStart"), HasSubstr(" --provisioning " + where)) << service;
    EXPECT_THAT(valueIn(text, "After"), HasSubstr("media-pleinair.mount")) << service;
  }
  EXPECT_THAT(valueIn(textOf(folder_.path() / "pleinair-rescue@.service"), "ExecStart"),
              HasSubstr(" --provisioned"));
  // udev starts the mount for the label that it mounts.
  const std::string rules = textOf(PLEINAIR_UDEV_RULES);
  const std::string device = valueIn(mount, "What");
  EXPECT_THAT(rules,
              HasSubstr("ENV{ID_FS_LABEL}==\"" + fs::path(device).filename().string() + "\""));
  EXPECT_THAT(rules, HasSubstr("ENV{SYSTEMD_WANTS}+=\"media-pleinair.mount\""));
  EXPECT_THAT(rules, HasSubstr("ENV{ID_FS_TYPE}==\"" + valueIn(mount, "Type") + "\""));
}

// A service may open the kinds of devices that /proc/devices has when it starts: a display whose
// driver comes later could not be opened.
TEST(DeviceKinds, OfModulesAreKnownBeforeTheServicesStart) {
  const std::map<std::string, std::string> modules{{"video4linux", "videodev"},
                                                   {"dma_heap", ""},
                                                   {"media", "mc"},
                                                   {"drm", "drm"},
                                                   {"input", ""},
                                                   {"tty", ""}};
  const std::string loaded = "\n" + textOf(PLEINAIR_MODULES);
  int kinds = 0;
  for (const std::string unit : {"pleinair-kiosk.service", "pleinair-rescue@.service"}) {
    const std::string text = textOf(kUnits / unit);
    static const std::regex kAllowed(R"(DeviceAllow=char-(\S+))");
    for (std::sregex_iterator each(text.begin(), text.end(), kAllowed), end; each != end; ++each) {
      const auto module = modules.find((*each)[1]);
      ASSERT_NE(module, modules.end()) << (*each)[1];
      if (module->second.empty()) continue;  // part of the kernel
      EXPECT_THAT(loaded, HasSubstr("\n" + module->second + "\n")) << (*each)[1];
      ++kinds;
    }
  }
  EXPECT_GE(kinds, 4);
}

TEST_F(Units, OfTheRescueForgetFailuresThatWouldKeepTheServiceFromStarting) {
  EXPECT_THAT(valueIn(textOf(folder_.path() / "pleinair-rescue@.service"), "ExecStopPost"),
              HasSubstr("reset-failed %i.service"));
}

TEST_F(Units, AreJudgedByWhatTheySay) {
  const fs::path kiosk = folder_.path() / "pleinair-kiosk.service";
  std::ofstream(kiosk, std::ios::app) << "\n[Service]\nPrivateNetwork=no\nSystemCallFilter=\n";
  EXPECT_GT(exposureOf("pleinair-kiosk.service"), 1.0) << "a control";
}

TEST_F(Units, StayCloseWithTheDropInForSoftwareGl) {
  for (const std::string service : {"pleinair-kiosk.service", "pleinair-repair-station.service"}) {
    addDropIn(service, "software-gl.conf");
    EXPECT_LE(exposureOf(service), 1.0) << service;
    EXPECT_EQ(analyze("verify", service).text, "") << service;
  }
}

TEST_F(Units, StayCloseWithTheDropInForUsb3Cameras) {
  addDropIn("pleinair-kiosk.service", "usb3-camera.conf");
  EXPECT_LE(exposureOf("pleinair-kiosk.service"), 1.0);
  EXPECT_EQ(analyze("verify", "pleinair-kiosk.service").text, "");
}

TEST_F(Units, FollowTheKernelsWords) {
  const fs::path words = folder_.path() / "words";
  const auto generate = [&](const std::string& line) {
    std::ofstream(words) << line << '\n';
    const fs::path folder = folder_.path() / "generated";
    fs::remove_all(folder);
    fs::create_directories(folder);
    const Answer answer = ask("PLEINAIR_CMDLINE='" + words.string() +
                              "' sh " PLEINAIR_GENERATOR " '" + folder.string() + "'");
    EXPECT_EQ(answer.text, "") << line;
    return folder / "pleinair-kiosk.service.d";
  };
  const fs::path both = generate("quiet pleinair.software_gl pleinair.time_zone=Europe/Berlin");
  EXPECT_THAT(textOf(both / "time-zone.conf"), HasSubstr("\nEnvironment=TZ=:Europe/Berlin\n"));
  EXPECT_EQ(textOf(both / "software-gl.conf"), textOf(kDropIns / "software-gl.conf"));
  for (const char* line : {"quiet", "pleinair.time_zone=", "pleinair.time_zone=a%b",
                           "pleinair.time_zone=$(touch;x)"}) {
    EXPECT_FALSE(fs::exists(generate(line))) << line;
  }
}

TEST_F(Units, HaveAScoreOfTheirOwnWithTheDropInForGigECameras) {
  addDropIn("pleinair-kiosk.service", "gige-camera.conf");
  const double exposure = exposureOf("pleinair-kiosk.service");
  EXPECT_LE(exposure, 1.6);
  EXPECT_GT(exposure, 1.0) << "it is applied";
  EXPECT_EQ(analyze("verify", "pleinair-kiosk.service").text, "");
}

}  // namespace
}  // namespace pleinair
