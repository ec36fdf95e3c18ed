#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/firmware_app/doctor/healthy_machine.h"

namespace pleinair::app::doctor {
namespace {

using testing::HasSubstr;

/// A machine with a GigE camera at 10.0.0.2, behind eth1.
class CheckCameraLinks : public testing::Test {
 protected:
  CheckCameraLinks() {
    machine_.cameras.cameras = {{.identity = {.backend = "aravis", .id = "Basler-1"},
                                 .node = "10.0.0.2",
                                 .areModesKnown = false}};
    machine_.files["/proc/net/route"] =
        "Iface\tDestination\tGateway\tFlags\tRefCnt\tUse\tMetric\tMask\tMTU\tWindow\tIRTT\n"
        "eth0\t00000000\t0101A8C0\t0003\t0\t0\t0\t00000000\t0\t0\t0\n"
        "eth1\t0000000A\t00000000\t0001\t0\t0\t0\t00FFFFFF\t0\t0\t0\n";
    for (const std::string device : {"eth0", "eth1"}) {
      machine_.files["/sys/class/net/" + device + "/mtu"] = "9000";
      machine_.files["/sys/class/net/" + device + "/speed"] = "1000";
    }
  }
  Finding check(double megapixelsPerSecond = 30) {
    Probes probes = machine_.probes();
    probes.askedPixelsPerSecond = [=] { return megapixelsPerSecond * 1e6; };
    return checkCameraLinks(probes);
  }
  HealthyMachine machine_;
};

TEST_F(CheckCameraLinks, IsContentWithoutNetworkedCameras) {
  machine_.cameras.cameras[0].node = "/dev/video0";
  EXPECT_EQ(check().verdict, Verdict::kOk);
  EXPECT_EQ(check().text, "no camera is on the network");
}

TEST_F(CheckCameraLinks, NamesTheDeviceOfTheNearestRoute) {
  const Finding finding = check();
  EXPECT_EQ(finding.verdict, Verdict::kOk);
  EXPECT_EQ(finding.text, "Basler-1 at eth1: MTU 9000, 1000 Mbit/s");
  machine_.cameras.cameras[0].node = "192.168.7.7";
  EXPECT_THAT(check().text, HasSubstr("at eth0"));
}

TEST_F(CheckCameraLinks, WarnsWhereNoNetworkLeadsThere) {
  machine_.files["/proc/net/route"] = "Iface\tDestination\n";
  const Finding finding = check();
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_EQ(finding.text, "Basler-1: no network leads to 10.0.0.2");
}

TEST_F(CheckCameraLinks, WarnsOfALinkThatIsTooSlow) {
  machine_.files["/sys/class/net/eth1/speed"] = "100";
  const Finding finding = check(27.648);  // 1280x720 at 30
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_THAT(finding.text, HasSubstr("need 234 at 8 bits a pixel"));
  EXPECT_THAT(finding.remedy, HasSubstr("camera.rate"));
}

TEST_F(CheckCameraLinks, WarnsOfASmallMtu) {
  machine_.files["/sys/class/net/eth1/mtu"] = "1400";
  EXPECT_EQ(check().verdict, Verdict::kWarning);
  EXPECT_EQ(check().remedy, "sudo ip link set eth1 mtu 1500");
}

TEST_F(CheckCameraLinks, RecommendsJumboFramesOnlyForMuch) {
  machine_.files["/sys/class/net/eth1/mtu"] = "1500";
  EXPECT_EQ(check(20).verdict, Verdict::kOk);
  const Finding finding = check(60);
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_THAT(finding.remedy, HasSubstr("ip link set eth1 mtu 9000"));
}

TEST(CheckCameras, TakesACameraThatTellsItsModesOnlyWhenOpenedForUsable) {
  HealthyMachine machine;
  machine.cameras.cameras = {{.identity = {.backend = "aravis", .id = "x", .description = "Basler"},
                              .node = "10.0.0.2",
                              .areModesKnown = false}};
  EXPECT_EQ(checkCameras(machine.probes()).text, "10.0.0.2 (Basler)");
}

}  // namespace
}  // namespace pleinair::app::doctor
