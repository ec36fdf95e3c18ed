// The meaning of a configuration that was read: how errors name their place, how values are
// printed, which options they give.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_app/config/configured_parts.h"
#include "tests/unit/firmware_app/configuration_test.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

// ---- what comes later

TEST_F(ConfigurationTest, AttributesThePlaceThatNamedAFile) {
  request_.siteFile = write("s.toml", "[painting]\nscene = \"absent.toml\"\n");
  const Configuration configuration = resolved();
  const auto message = [](const Configuration& of) -> std::string {
    try {
      of.attributing([&] { return configuredScene(of); });
    } catch (const config::ConfigError& error) {
      return error.what();
    }
    return "(nothing thrown)";
  };
  EXPECT_EQ(message(configuration),
            path("s.toml").string() + ":2: painting.scene: " + path("absent.toml").string() +
                ": cannot open: No such file or directory, allowed: a TOML file of at most 1 MiB");
  // One that a person has just typed is known to them.
  request_.options = {{"painting.scene", path("typed.toml").string(), "--scene"}};
  EXPECT_THAT(message(resolved()), StartsWith(path("typed.toml").string() + ": cannot open"));
}

TEST_F(ConfigurationTest, LeavesAMistakeWithinAFileToItsLine) {
  request_.siteFile = write("s.toml", "[painting]\nscene = \"scene.toml\"\n");
  write("scene.toml", "[[tag]]\nid = -1\n");
  const Configuration configuration = resolved();
  try {
    configuration.attributing([&] { return configuredScene(configuration); });
    ADD_FAILURE() << "nothing thrown";
  } catch (const config::ConfigError& error) {
    EXPECT_THAT(error.what(), StartsWith(path("scene.toml").string() + ":2: tag[0].id: "));
  }
}

TEST_F(ConfigurationTest, SaysWhichKindOfFileAnotherSeemsToBe) {
  const fs::path site = write("s.toml", "[camera]\nrate = 15\n[painting]\nlook = \"oil\"\n");
  request_.options = {{"painting.scene", site.string(), "--scene"}};
  const Configuration configuration = resolved();
  try {
    configuredScene(configuration);
    ADD_FAILURE() << "taken";
  } catch (const config::ConfigError& error) {
    EXPECT_THAT(error.what(), StartsWith(site.string() + ": seems to be a configuration, not a"));
    EXPECT_THAT(error.what(), HasSubstr("--config FILE"));
  }
  request_.options.clear();
  request_.siteFile = write("desk.toml", "[camera]\nfx = 600\n\n[[tag]]\nid = 0\n");
  EXPECT_EQ(refusal(), path("desk.toml").string() +
                           ":4: seems to be a scene, not a configuration, allowed: a site file; a "
                           "scene is given as --scene FILE");
}

TEST_F(ConfigurationTest, TakesADeviceNodeForItsCamera) {
  request_.options = {{"camera.source", "/dev/video9", "--camera"}};
  const CameraSettings camera = resolved().camera();
  EXPECT_EQ(camera.source, "v4l2:/dev/video9");
  EXPECT_FALSE(isRecording(camera)) << "it is waited for";
}

TEST_F(ConfigurationTest, AttributesThePlaceOfWhatADeviceRefuses) {
  request_.environment = {{"PLEINAIR_CAMERA_SOURCE", "/gone.mp4"}};
  const Configuration configuration = resolved();
  const auto subject = [&](const std::string& of) {
    try {
      configuration.attributing([&] { throw hal::Failure({.subject = of, .problem = "no"}); });
    } catch (const hal::Failure& error) {
      return error.error().subject;
    }
    return std::string("(nothing thrown)");
  };
  EXPECT_EQ(subject("/gone.mp4"), "PLEINAIR_CAMERA_SOURCE: camera.source: /gone.mp4");
  EXPECT_EQ(subject("/other.mp4"), "/other.mp4");
}

// ---- what is printed

TEST_F(ConfigurationTest, WhatItPrintsIsASiteFileOfTheSameValues) {
  request_.profile = "kiosk";
  request_.siteFile =
      write("s.toml", "[painting]\nscene = \"a \\\"b\\\".toml\"\nsize = \"320x240\"\n");
  request_.environment = {{"PLEINAIR_CAMERA_RATE", "12.5"}};
  request_.options = {{"painting.look", "wet_in_wet", "--look"}};
  request_.set = {"wobble=0.1"};
  const Configuration configuration = resolved();
  for (const auto which : {config::Printed::kAll, config::Printed::kGiven}) {
    fs::create_directories(path("elsewhere"));
    ConfigurationRequest again;
    again.defaultSiteFile = write("elsewhere/copy.toml", configuration.toToml(which));
    const Configuration copy(again);
    EXPECT_EQ(copy.styleParameters(), configuration.styleParameters());
    EXPECT_EQ(copy.painting().scene, path("a \"b\".toml"));
    EXPECT_EQ(copy.painting().look, "wet_in_wet");
    EXPECT_EQ(copy.painting().size, configuration.painting().size);
    EXPECT_EQ(copy.camera().framesPerSecond, 12.5);
    EXPECT_EQ(copy.output().targets, configuration.output().targets);
    EXPECT_EQ(copy.camera().source, configuration.camera().source);
  }
}

TEST_F(ConfigurationTest, TheShortFormKeepsALookOpen) {
  request_.options = {{"painting.look", "wet_in_wet", "--look"}};
  const std::string given = resolved().toToml(config::Printed::kGiven);
  EXPECT_THAT(given, HasSubstr("look = \"wet_in_wet\"  # --look\n"));
  EXPECT_THAT(given, testing::Not(HasSubstr("bleeding")));
}

TEST_F(ConfigurationTest, TellsEveryKindOfOrigin) {
  request_.profile = "kiosk";
  request_.siteFile = write("s.toml", "[camera.synthetic]\nseed = 5\n");
  request_.environment = {{"PLEINAIR_CAMERA_RATE", "12.5"}};
  request_.options = {{"painting.look", "wet_in_wet", "--look"}};
  request_.set = {"wobble=0.1"};
  const std::string toml = resolved().toToml(config::Printed::kAll);
  for (const std::string line :
       {"profile = \"kiosk\"  # --profile\n", "cell_size = 12  # profile kiosk:17\n",
        "rate = 12.5  # PLEINAIR_CAMERA_RATE\n", "look = \"wet_in_wet\"  # --look\n",
        "wobble = 0.1  # --set wobble\n", "bleeding = 2  # look wet_in_wet\n",
        "view = \"finished\"  # default\n"}) {
    EXPECT_THAT(toml, HasSubstr("\n" + line));
  }
  EXPECT_THAT(toml, HasSubstr("\nseed = 5  # " + path("s.toml").string() + ":2\n"));
}

// ---- what does not go together

TEST_F(ConfigurationTest, RefusesALatencyAboveTheMost) {
  request_.set = {"runtime.latency=500"};
  EXPECT_EQ(refusal(),
            "--set runtime.latency: found 500, allowed: at most 400, which is runtime.max_latency "
            "(default)");
  request_.set = {"runtime.max_latency=100"};
  EXPECT_EQ(refusal(),
            "--set runtime.max_latency: found 100, allowed: at least 120, which is runtime.latency "
            "(default)");
  request_.set = {"runtime.latency=500", "runtime.max_latency=500"};
  EXPECT_EQ(resolved().runtime().latencyMs, 500);
  request_.set.clear();
  request_.siteFile = write("s.toml", "[runtime]\nlatency = 300\nmax_latency = 200\n");
  EXPECT_EQ(refusal(), path("s.toml").string() +
                           ":2: runtime.latency: found 300, allowed: at most 200, which is "
                           "runtime.max_latency (" +
                           path("s.toml").string() + ":3)");
}

TEST_F(ConfigurationTest, RefusesAnAddressThatIsNone) {
  for (const std::string listen : {"9117", "localhost:9117", "127.0.0.1:70000", ""}) {
    request_.set = {"status.listen=" + listen};
    EXPECT_EQ(refusal(), "--set status.listen: found \"" + listen +
                             "\", allowed: off, or ADDRESS:PORT such as 127.0.0.1:9117");
  }
  request_.set = {"status.listen=[::1]:9117"};
  EXPECT_EQ(resolved().status().listen, "[::1]:9117");
}

// ---- what it means

TEST_F(ConfigurationTest, BecomesKeyboardsWhereThereIsADisplayAndNoWindow) {
  const auto with = [&](const std::string& targets, const std::string& keyboards) {
    request_.set = {"output.targets=" + targets, "input.keyboards=" + keyboards, "input.grab=true"};
    return configuredKeyboards(resolved());
  };
  EXPECT_TRUE(with("display", "auto")->all);
  EXPECT_TRUE(with("display", "auto")->grabs);
  EXPECT_TRUE(with("loopback:x,display:HDMI-A-1", "auto").has_value());
  EXPECT_FALSE(with("window,display", "auto").has_value()) << "the keys are the window's";
  EXPECT_FALSE(with("out.mp4", "auto").has_value());
  EXPECT_FALSE(with("display", "none").has_value());
  EXPECT_EQ(with("out.mp4", "USB Foot Switch")->named, std::vector<std::string>{"USB Foot Switch"});
}

TEST_F(ConfigurationTest, BecomesAPaintersOptions) {
  request_.set = {"painting.view=cells", "painting.size=320x240", "cell_size=20"};
  const PaintingOptions options = configuredPainting(resolved(), {.output = "o.mp4"});
  EXPECT_EQ(options.output, "o.mp4");
  EXPECT_EQ(options.style, "watercolor");
  EXPECT_EQ(options.view, "cells");
  EXPECT_EQ(options.size, (hal::FrameSize{320, 240}));
  ASSERT_TRUE(options.parameters);
  EXPECT_EQ(options.parameters->text("cell_size"), "20");
  request_.set.clear();
  const PaintingOptions plain = configuredPainting(resolved(), {});
  EXPECT_EQ(plain.view, "");
  EXPECT_FALSE(plain.size);
}

TEST_F(ConfigurationTest, BecomesASyntheticCamerasOptions) {
  request_.set = {"camera.rate=25",
                  "camera.size=320x240",
                  "camera.synthetic.seed=7",
                  "camera.synthetic.noise=0",
                  "camera.source=synthetic:roll",
                  "camera.synthetic.exposure_drift=0.5",
                  "camera.synthetic.white_balance_drift=0.1",
                  "camera.synthetic.readout=0.5"};
  const CameraSettings camera = resolved().camera();
  EXPECT_TRUE(isSynthetic(camera));
  const hal::SyntheticOptions options = syntheticOptions(camera);
  EXPECT_EQ(options.framePeriod, std::chrono::milliseconds(40));
  EXPECT_EQ(options.size, (hal::FrameSize{320, 240}));
  EXPECT_EQ(options.seed, 7u);
  EXPECT_EQ(options.noiseSigma, 0);
  EXPECT_EQ(options.shot, hal::SyntheticShot::kRoll);
  EXPECT_EQ(options.exposureDriftStops, 0.5);
  EXPECT_EQ(options.whiteBalanceDrift, 0.1);
  EXPECT_EQ(options.rowTime, std::chrono::nanoseconds(40'000'000 / 2 / 240));
  // The defaults are the camera's own.
  const hal::SyntheticOptions defaults = syntheticOptions(CameraSettings());
  EXPECT_EQ(defaults.framePeriod, hal::SyntheticOptions().framePeriod);
  EXPECT_EQ(defaults.noiseSigma, hal::SyntheticOptions().noiseSigma);
  EXPECT_EQ(defaults.seed, hal::SyntheticOptions().seed);
  EXPECT_EQ(defaults.shot, hal::SyntheticOptions().shot);
  EXPECT_EQ(defaults.rowTime, hal::SyntheticOptions().rowTime);
  EXPECT_EQ(defaults.size, hal::SyntheticOptions().size);
}

}  // namespace
}  // namespace pleinair::app
