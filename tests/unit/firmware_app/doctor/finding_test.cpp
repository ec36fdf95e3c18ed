#include "firmware_app/doctor/finding.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/unit/firmware_app/doctor/healthy_machine.h"

namespace pleinair::app::doctor {
namespace {

const std::vector<Finding>& mixed() {
  static const std::vector<Finding> kFindings{
      {.check = "OpenGL ES", .text = "3.2 on Mali"},
      {.check = "disk", .verdict = Verdict::kWrong, .text = "full", .remedy = "rm it"},
      {.check = "udev", .verdict = Verdict::kWarning, .text = "off", .remedy = "start it"}};
  return kFindings;
}

TEST(Findings, AreALineEachWithTheRemedyBelow) {
  EXPECT_EQ(asText(mixed()),
            "ok       OpenGL ES  3.2 on Mali\n"
            "WRONG    disk       full\n"
            "                    -> rm it\n"
            "warning  udev       off\n"
            "                    -> start it\n"
            "\n"
            "1 thing to fix; 1 warning.\n");
}

TEST(Findings, SayWhetherAllIsWell) {
  EXPECT_TRUE(asText({mixed()[0]}).ends_with("\nAll is well.\n"));
  EXPECT_TRUE(asText({mixed()[2], mixed()[2]}).ends_with("\nNothing is wrong; 2 warnings.\n"));
}

TEST(Findings, AreJson) {
  std::vector<Finding> findings = mixed();
  findings[0].text = "a \"quoted\" \xff name";
  const nlohmann::json document = nlohmann::json::parse(asJson(findings));
  EXPECT_EQ(document["wrong"], 1);
  EXPECT_EQ(document["warnings"], 1);
  ASSERT_EQ(document["checks"].size(), 3u);
  EXPECT_EQ(document["checks"][0]["verdict"], "ok");
  EXPECT_EQ(document["checks"][1]["verdict"], "wrong");
  EXPECT_EQ(document["checks"][1]["remedy"], "rm it");
}

TEST(Examine, FindsAHealthyMachineWell) {
  HealthyMachine machine;
  const std::vector<Finding> findings = examine(machine.probes());
  EXPECT_EQ(findings.size(), 19u);
  for (const Finding& each : findings) {
    EXPECT_EQ(each.verdict, Verdict::kOk) << each.check << ": " << each.text;
    EXPECT_FALSE(each.text.empty()) << each.check;
    EXPECT_TRUE(each.remedy.empty()) << each.check;
  }
}

TEST(Examine, SaysWhatToDoAboutEverythingThatIsNot) {
  HealthyMachine machine;
  machine.files.clear();
  machine.folders.clear();
  machine.limits = {{RLIMIT_RTPRIO, 0}, {RLIMIT_MEMLOCK, 0}};
  machine.freeBytes = 0;
  machine.graphics = tl::unexpected(errorOf(hal::ErrorKind::kUnsupported, "none"));
  machine.cameras = {};
  machine.loopbacks.clear();
  machine.configurationError = "site.toml: broken";
  for (const Finding& each : examine(machine.probes())) {
    EXPECT_EQ(each.verdict == Verdict::kOk, each.remedy.empty()) << each.check;
  }
}

}  // namespace
}  // namespace pleinair::app::doctor
