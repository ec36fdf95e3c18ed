#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/firmware_app/doctor/healthy_machine.h"

namespace pleinair::app::doctor {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

TEST(CheckGraphics, TellsTheRenderer) {
  HealthyMachine machine;
  const Finding finding = checkGraphics(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kOk);
  EXPECT_EQ(finding.text, "OpenGL ES 3.2 Mesa 22.3.6 on Mali-G52");
  EXPECT_THAT(finding.remedy, IsEmpty());
}

TEST(CheckGraphics, WarnsOfSoftware) {
  HealthyMachine machine;
  machine.graphics->isSoftware = true;
  const Finding finding = checkGraphics(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_THAT(finding.text, HasSubstr("software"));
  EXPECT_THAT(finding.remedy, HasSubstr("the GPU's own driver, or paint smaller: --size"));
  machine.folders["/dev/dri"] = {};
  EXPECT_EQ(checkGraphics(machine.probes()).remedy, "paint smaller: --size 320x240");
}

TEST(CheckGraphics, IsWrongWithoutAContext) {
  HealthyMachine machine;
  machine.graphics =
      tl::unexpected(errorOf(hal::ErrorKind::kUnsupported, "surfaceless: no display"));
  const Finding finding = checkGraphics(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWrong);
  EXPECT_THAT(finding.text, HasSubstr("surfaceless: no display"));
  EXPECT_THAT(finding.remedy, HasSubstr("apt install libegl1"));
}

TEST(CheckFrameImport, TellsThePathTheReasonAndTheTime) {
  HealthyMachine machine;
  const Finding imported = checkFrameImport(machine.probes());
  EXPECT_EQ(imported.text, "the GPU reads them in shared memory (heap; trial: 80 ms)");
  machine.frameImport = {.reason = "vgem: its module is not loaded",
                         .took = std::chrono::milliseconds(3)};
  const Finding uploaded = checkFrameImport(machine.probes());
  EXPECT_EQ(uploaded.verdict, Verdict::kOk) << "it paints the same";
  EXPECT_EQ(uploaded.text, "are uploaded: vgem: its module is not loaded (trial: 3 ms)");
}

TEST(CheckRenderNodes, TakesTheFirstThatMayBeUsed) {
  HealthyMachine machine;
  EXPECT_EQ(checkRenderNodes(machine.probes()).text, "/dev/dri/renderD128");
  machine.folders["/dev/dri"] = {"/dev/dri/renderD128", "/dev/dri/renderD129"};
  machine.refused["/dev/dri/renderD128"] = EACCES;
  const Finding finding = checkRenderNodes(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kOk);
  EXPECT_EQ(finding.text, "/dev/dri/renderD129");
  EXPECT_THAT(finding.remedy, IsEmpty());
}

TEST(CheckRenderNodes, AsksForTheGroup) {
  HealthyMachine machine;
  machine.refused["/dev/dri/renderD128"] = EACCES;
  const Finding finding = checkRenderNodes(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWrong);
  EXPECT_THAT(finding.text, HasSubstr("Permission denied"));
  EXPECT_THAT(finding.remedy, HasSubstr("usermod -aG render"));
}

TEST(CheckRenderNodes, WarnsWhereThereAreNone) {
  HealthyMachine machine;
  machine.folders["/dev/dri"] = {"/dev/dri/card0"};
  EXPECT_EQ(checkRenderNodes(machine.probes()).verdict, Verdict::kWarning);
}

}  // namespace
}  // namespace pleinair::app::doctor
