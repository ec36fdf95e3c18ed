#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/firmware_app/doctor/healthy_machine.h"

namespace pleinair::app::doctor {
namespace {

using testing::HasSubstr;

constexpr std::uint64_t kMB = 1'000'000;

TEST(CheckSocketBuffers, WantsFourMegabytes) {
  HealthyMachine machine;
  EXPECT_EQ(checkSocketBuffers(machine.probes()).verdict, Verdict::kOk);
  for (const char* text : {"212992", "3999999", "", "none"}) {
    machine.files["/proc/sys/net/core/rmem_max"] = text;
    const Finding finding = checkSocketBuffers(machine.probes());
    EXPECT_EQ(finding.verdict, Verdict::kWarning) << text;
    EXPECT_THAT(finding.remedy, HasSubstr("net.core.rmem_max="));
  }
  machine.files["/proc/sys/net/core/rmem_max"] = "4000000";
  EXPECT_EQ(checkSocketBuffers(machine.probes()).verdict, Verdict::kOk);
}

TEST(CheckPriority, WantsSome) {
  HealthyMachine machine;
  EXPECT_EQ(checkPriority(machine.probes()).text, "real-time up to 50");
  machine.limits[RLIMIT_RTPRIO] = RLIM_INFINITY;
  EXPECT_EQ(checkPriority(machine.probes()).text, "real-time up to 99");
  machine.limits[RLIMIT_RTPRIO] = 5;
  EXPECT_EQ(checkPriority(machine.probes()).verdict, Verdict::kWarning) << "10 is asked for";
  machine.limits[RLIMIT_RTPRIO] = 0;
  const Finding finding = checkPriority(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_THAT(finding.remedy, HasSubstr("rtprio"));
  std::string& status = machine.files["/proc/self/status"];
  status = "CapPrm:\t0000000000800000\nCapEff:\t0000000000000000\n";
  EXPECT_EQ(checkPriority(machine.probes()).verdict, Verdict::kWarning);
  status = "Name:\tpleinair\nCapEff:\t0000000000800000\nCapBnd:\t0\n";
  EXPECT_EQ(checkPriority(machine.probes()).text, "real-time up to 99") << "CAP_SYS_NICE";
}

TEST(CheckLockedMemory, WantsWhatDriversCountOn) {
  HealthyMachine machine;
  EXPECT_EQ(checkLockedMemory(machine.probes()).text, "64 MiB");
  machine.limits[RLIMIT_MEMLOCK] = RLIM_INFINITY;
  EXPECT_EQ(checkLockedMemory(machine.probes()).text, "unlimited");
  machine.limits[RLIMIT_MEMLOCK] = 64 << 10;
  const Finding finding = checkLockedMemory(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_THAT(finding.text, HasSubstr("64 KiB"));
}

TEST(CheckClock, WarnsOfPoorOnes) {
  HealthyMachine machine;
  EXPECT_EQ(checkClock(machine.probes()).verdict, Verdict::kOk);
  std::string& current =
      machine.files["/sys/devices/system/clocksource/clocksource0/current_clocksource"];
  current = "arch_sys_counter";
  EXPECT_EQ(checkClock(machine.probes()).verdict, Verdict::kOk);
  current = "hpet";
  const Finding finding = checkClock(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_THAT(finding.remedy, HasSubstr("tsc hpet acpi_pm"));
}

TEST(CheckUdev, WarnsWhereItDoesNotRun) {
  HealthyMachine machine;
  EXPECT_EQ(checkUdev(machine.probes()).verdict, Verdict::kOk);
  machine.folders["/run/udev"] = {"/run/udev/data"};
  EXPECT_EQ(checkUdev(machine.probes()).verdict, Verdict::kWarning);
}

TEST(CheckConfiguration, RepeatsTheError) {
  HealthyMachine machine;
  EXPECT_EQ(checkConfiguration(machine.probes()).verdict, Verdict::kOk);
  machine.configurationError = "site.toml:3: look: unknown key";
  const Finding finding = checkConfiguration(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWrong);
  EXPECT_EQ(finding.text, "site.toml:3: look: unknown key");
}

TEST(CheckRequested, SaysOfEachPartWhetherItIsThereAndWhatFixesIt) {
  HealthyMachine machine;
  hal::Error missing{.kind = hal::ErrorKind::kNotFound,
                     .subject = "/srv/out.mp4",
                     .problem = "its folder /srv is not there",
                     .remedy = "mkdir -p '/srv'"};
  hal::Error broken{.kind = hal::ErrorKind::kInvalidArgument,
                    .subject = "configuration",
                    .problem = "desk.toml:3: tag[0].edge_m: missing",
                    .remedy = {}};
  machine.requested = {{.part = "camera", .value = "auto", .problem = missing, .isChosen = false},
                       {.part = "output", .value = "/srv/out.mp4", .problem = missing},
                       {.part = "scene", .value = "desk.toml", .problem = broken},
                       {.part = "style", .value = "painterly"}};
  const std::vector<Finding> findings = checkRequested(machine.probes());
  ASSERT_EQ(findings.size(), 4U);
  EXPECT_EQ(findings[0].check, "requested camera");
  EXPECT_EQ(findings[0].verdict, Verdict::kWarning) << "a default, or waited for";
  EXPECT_EQ(findings[1].verdict, Verdict::kWrong);
  EXPECT_EQ(findings[1].text, "/srv/out.mp4: its folder /srv is not there");
  EXPECT_EQ(findings[1].remedy, "mkdir -p '/srv'");
  EXPECT_EQ(findings[2].verdict, Verdict::kWrong);
  EXPECT_EQ(findings[2].text, "desk.toml:3: tag[0].edge_m: missing");
  EXPECT_THAT(findings[2].remedy, HasSubstr("pleinair config"));
  EXPECT_EQ(findings[3].verdict, Verdict::kOk);
  EXPECT_EQ(examine(machine.probes()).back().check, "requested style");
}

TEST(CheckDisk, WarnsBeforeItIsFull) {
  HealthyMachine machine;
  EXPECT_EQ(checkDisk(machine.probes()).text, "/srv/snapshots: 20000 MB free");
  machine.freeBytes = 999 * kMB;
  EXPECT_EQ(checkDisk(machine.probes()).verdict, Verdict::kWarning);
  machine.freeBytes = 99 * kMB;
  EXPECT_EQ(checkDisk(machine.probes()).verdict, Verdict::kWrong);
  machine.freeBytes = std::nullopt;
  EXPECT_EQ(checkDisk(machine.probes()).verdict, Verdict::kWarning);
}

TEST(CheckDisk, IsWrongWhereNothingCanBeSaved) {
  HealthyMachine machine;
  machine.refused["/srv/snapshots"] = ENOENT;
  const Finding finding = checkDisk(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWrong);
  EXPECT_THAT(finding.text, HasSubstr("No such file or directory"));
  EXPECT_THAT(finding.remedy, HasSubstr("'/srv/snapshots'"));
}

TEST(CheckMemory, ReadsWhatIsAvailable) {
  HealthyMachine machine;
  EXPECT_EQ(checkMemory(machine.probes()).text, "4096 MiB available");
  machine.files["/proc/meminfo"] = "MemAvailable:  409600 kB";
  EXPECT_EQ(checkMemory(machine.probes()).verdict, Verdict::kWarning);
  machine.files["/proc/meminfo"] = "MemAvailable:  102400 kB";
  EXPECT_EQ(checkMemory(machine.probes()).verdict, Verdict::kWrong);
  for (const char* text : {"", "MemAvailable:", "MemAvailable: none"}) {
    machine.files["/proc/meminfo"] = text;
    EXPECT_EQ(checkMemory(machine.probes()).verdict, Verdict::kOk) << text;
  }
}

}  // namespace
}  // namespace pleinair::app::doctor
