#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "firmware_app/commands/procedure.h"
#include "firmware_app/overlay/step_content.h"
#include "hal/error.h"
#include "pipeline/procedure/procedure_file.h"
#include "pipeline/record/work_session.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

const fs::path kShipped = fs::path(PLEINAIR_TESTS_DIR).parent_path() / "config/procedures/gearbox";

class ProcedureCommands : public testing::Test {
 protected:
  /// The error of `procedure new`; empty if there is none.
  static std::string newError(const ProcedureNewOptions& options) {
    try {
      newProcedure(options);
    } catch (const hal::Failure& failure) {
      return failure.what();
    }
    return {};
  }

  support::TemporaryFolder folder_;
};

TEST_F(ProcedureCommands, TheShippedProcedureChecksClean) {
  EXPECT_EQ(checkProcedure({.folder = kShipped}), 0);
}

TEST_F(ProcedureCommands, MistakesAndLikelyMistakesHaveStatusesOfTheirOwn) {
  EXPECT_EQ(checkProcedure({.folder = folder_.path()}), 2);
  std::ofstream(folder_.path() / "procedure.toml")
      << "name = \"p\"\nversion = \"1\"\nlanguages = [\"en\"]\n[model]\nsource = "
         "\"builtin:gearbox\"\n"
         "[tools]\nhex = { en = \"hex key\" }\n[[step]]\nid = \"a\"\n";
  std::ofstream(folder_.path() / "en.md") << "# T\n## a: A\n";
  EXPECT_EQ(checkProcedure({.folder = folder_.path()}), 1) << "a tool that no step needs";
}

TEST_F(ProcedureCommands, ANewProcedureIsSoundAndOverwritesNothing) {
  const ProcedureNewOptions options{
      .folder = folder_.path() / "mine", .model = "builtin:gearbox", .languages = {"en", "de"}};
  EXPECT_EQ(newProcedure(options), 0);
  EXPECT_EQ(checkProcedure({.folder = options.folder}), 1) << "its texts are to be written";
  EXPECT_EQ(procedure::loadProcedure(options.folder).name, "mine");
  EXPECT_THAT(newError(options), testing::HasSubstr("exists already"));
}

TEST_F(ProcedureCommands, NewSaysWhatItCannotTake) {
  const fs::path made = folder_.path() / "mine";
  EXPECT_THAT(newError({.folder = made, .model = "/tmp/machine.gltf"}),
              testing::HasSubstr("may have its data in other files"));
  EXPECT_THAT(newError({.folder = made, .model = "builtin:gearbox", .languages = {"English"}}),
              testing::HasSubstr("found \"English\""));
  EXPECT_NE(newError({.folder = made, .model = (folder_.path() / "none.glb").string()}), "");
  EXPECT_FALSE(fs::exists(made)) << "nothing is left behind";
}

TEST_F(ProcedureCommands, ANewProcedureOfAnStlHasItsUnits) {
  const fs::path stl = folder_.path() / "bracket.stl";
  std::ofstream(stl) << "solid bracket\n"
                        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 120 0 0\n"
                        "vertex 0 80 40\nendloop\nendfacet\n"
                        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 80 40\n"
                        "vertex 0 80 0\nendloop\nendfacet\nendsolid bracket\n";
  const fs::path made = folder_.path() / "mine";
  EXPECT_THAT(newError({.folder = made, .model = stl.string()}), testing::HasSubstr("--units mm"));
  EXPECT_FALSE(fs::exists(made));
  EXPECT_EQ(newProcedure({.folder = made, .model = stl.string(), .units = "mm"}), 0);
  std::ofstream(made / "en.md", std::ios::app) << "Hold it.\n";
  EXPECT_EQ(checkProcedure({.folder = made}), 0) << "neither huge nor without units";
  EXPECT_EQ(procedure::loadProcedure(made).unitMetres, 0.001);
  EXPECT_THAT(
      newError({.folder = folder_.path() / "other", .model = "builtin:gearbox", .units = "mm"}),
      testing::HasSubstr("has no meaning"));
}

TEST_F(ProcedureCommands, AModelOfFiveHundredPartsIsTaken) {
  const fs::path made = folder_.path() / "large";
  fs::create_directories(made);
  std::string nodes;
  std::string roots;
  for (int i = 0; i < 500; ++i) {
    nodes += fmt::format(R"({}{{"name":"part_{}_a","mesh":0,"translation":[{},{},0]}})",
                         i == 0 ? "" : ",", i, 0.02 * (i % 25), 0.02 * (i / 25));
    roots += fmt::format("{}{}", i == 0 ? "" : ",", i);
  }
  // One triangle of 1 cm: nine numbers.
  std::ofstream(made / "large.gltf") << fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
      R"("min":[0,0,0],"max":[0.01,0.01,0]}}],"bufferViews":[{{"buffer":0,"byteLength":36}}],)"
      R"("buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
      R"(AAAAAAAAAAAAAAAACtcjPAAAAAAAAAAAAAAAAArXIzwAAAAA"}}]}})",
      roots, nodes);
  EXPECT_EQ(newProcedure({.folder = made, .model = (made / "large.gltf").string()}), 0);
  const procedure::Procedure procedure = procedure::loadProcedure(made);
  EXPECT_EQ(procedure.model->parts.size(), 500U);
  EXPECT_EQ(procedure.steps.size(), 500U);
  const StepShown last{.procedure = std::make_shared<const procedure::Procedure>(procedure),
                       .step = 499,
                       .language = "en"};
  const overlay::OverlayContent content =
      stepContent(last, *procedure.model, made, {640, 480}, stepInset(last, *procedure.model, 640));
  EXPECT_EQ(content.looks.size(), 500U);
  EXPECT_EQ(content.looks.back(), overlay::PartLook::kFocus);
  EXPECT_GT(content.inset.size().width, 0);
}

TEST_F(ProcedureCommands, ARecordIsCheckedAndReported) {
  const fs::path path = folder_.path() / "work.jsonl";
  const auto shipped =
      std::make_shared<const procedure::Procedure>(procedure::loadProcedure(kShipped));
  std::string finalHash;
  {
    auto session = record::WorkSession::begin(
        shipped, path, {.program = "1", .operatorName = "Jo", .language = "de"});
    ASSERT_TRUE(session);
    ASSERT_TRUE(session->answer(procedure::YesNo{true}));
    EXPECT_EQ(checkRecordOfWork({.record = path}), 1) << "not signed off";
    ASSERT_TRUE(session->signOff("enough"));
    finalHash = session->record().finalHash();
  }
  const fs::path report = folder_.path() / "work.html";
  EXPECT_EQ(checkRecordOfWork(
                {.record = path, .finalHash = finalHash, .report = report, .procedure = kShipped}),
            0);
  std::ifstream file(report);
  const std::string html{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  EXPECT_THAT(html, testing::HasSubstr("1. Antrieb sichern"));
  EXPECT_EQ(checkRecordOfWork({.record = path, .finalHash = std::string(64, '0')}), 1);
  EXPECT_THROW(checkRecordOfWork({.record = path, .report = path}), hal::Failure)
      << "a record is never overwritten";
}

}  // namespace
}  // namespace pleinair::app
