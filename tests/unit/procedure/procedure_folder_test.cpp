#include <array>
#include <cstring>
#include <fstream>
#include <string>
#include <utility>

#include <gmock/gmock.h>

#include "hal/media/png_file.h"
#include "tests/support/av_movie.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/procedure/procedure_texts.h"

namespace pleinair::procedure {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

class ProcedureFolderTest : public testing::Test {
 protected:
  void writeSound() {
    write(path("procedure.toml"), kHead + "[[step]]\nid = \"a\"\nparts = [\"oil_plug\"]\n");
    write(path("en.md"), "# T\n## a: A\n");
  }
  /// A triangle whose data is in files beside the model's.
  void writeGltf() {
    const std::array<float, 9> corners{0, 0, 0, 1, 0, 0, 0, 0, 0.5F};
    std::string bytes(sizeof corners, '\0');
    std::memcpy(bytes.data(), corners.data(), sizeof corners);
    write(path("plate.bin"), bytes);
    write(path("paint.png"), "a texture that nothing shows");
    write(path("plate.gltf"),
          R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
          R"("nodes":[{"name":"plate","mesh":0}],)"
          R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
          R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
          R"("min":[0,0,0],"max":[1,0,0.5]}],)"
          R"("bufferViews":[{"buffer":0,"byteLength":36}],)"
          R"("buffers":[{"uri":"plate.bin","byteLength":36}],"images":[{"uri":"paint.png"}]})");
  }
  void writeProcedureOf(const std::string& model) {
    write(path("procedure.toml"), "name = \"p\"\nversion = \"1\"\nlanguages = [\"en\"]\n[model]\n" +
                                      model + "\n[[step]]\nid = \"a\"\n");
    write(path("en.md"), "# T\n## a: A\n");
  }
  std::filesystem::path path(const char* name) const { return folder_.path() / name; }

  support::TemporaryFolder folder_;
};

TEST_F(ProcedureFolderTest, IsReadWithItsFilesAndHash) {
  writeSound();
  const Procedure procedure = loadProcedure(folder_.path());
  EXPECT_THAT(procedure.files, ElementsAre("en.md", "procedure.toml"));
  EXPECT_EQ(procedure.hash.size(), 64U);
  EXPECT_EQ(loadProcedure(folder_.path()).hash, procedure.hash);
  write(path("en.md"), "# T\n## a: B\n");
  EXPECT_NE(loadProcedure(folder_.path()).hash, procedure.hash) << "another text";
}

TEST_F(ProcedureFolderTest, FilesBesideAModelAreInTheHash) {
  writeGltf();
  writeProcedureOf("source = \"plate.gltf\"");
  const Procedure procedure = loadProcedure(folder_.path());
  EXPECT_THAT(procedure.files,
              ElementsAre("en.md", "paint.png", "plate.bin", "plate.gltf", "procedure.toml"));
  write(path("paint.png"), "another texture");
  const std::string painted = loadProcedure(folder_.path()).hash;
  EXPECT_NE(painted, procedure.hash);
  std::string bytes(36, '\0');
  write(path("plate.bin"), bytes);
  EXPECT_NE(loadProcedure(folder_.path()).hash, painted) << "another buffer";
}

TEST_F(ProcedureFolderTest, MaterialsBesideAMeshAreInTheHash) {
  write(path("plate.obj"), "mtllib my steel.mtl\no plate\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write(path("my steel.mtl"), "newmtl steel\nKd 0.5 0.5 0.5\n");
  writeProcedureOf("source = \"plate.obj\"\nunits = \"mm\"");
  const Procedure procedure = loadProcedure(folder_.path());
  EXPECT_THAT(procedure.files, ElementsAre("en.md", "my steel.mtl", "plate.obj", "procedure.toml"));
  write(path("my steel.mtl"), "newmtl steel\nKd 0.5 0.5 0.6\n");
  EXPECT_NE(loadProcedure(folder_.path()).hash, procedure.hash);
}

TEST_F(ProcedureFolderTest, AModelsUpIsSaidOrUsual) {
  writeGltf();
  const auto upOf = [&](const std::string& keys) {
    writeProcedureOf("source = \"plate.gltf\"\n" + keys);
    const Procedure procedure = loadProcedure(folder_.path());
    // The file's y, which glTF readers turn to z, or its z, which they turn to −y.
    return std::pair(procedure.uprightFromModel * glm::dvec3(0, 0, 1),
                     procedure.uprightFromModel * glm::dvec3(0, -1, 0));
  };
  EXPECT_NEAR(upOf("").first.z, 1.0, 1e-12);
  EXPECT_NEAR(upOf("up = \"y\"").first.z, 1.0, 1e-12);
  EXPECT_NEAR(upOf("up = \"z\"\nunits = \"mm\"").second.z, 1.0, 1e-12);
  writeProcedureOf("source = \"plate.gltf\"\nup = \"x\"");
  EXPECT_THAT(messagesOf(readProcedureFolder(folder_.path())), HasSubstr("model.up: found"));
}

TEST_F(ProcedureFolderTest, WhatIsMissingIsSaid) {
  EXPECT_THAT(messagesOf(readProcedureFolder(folder_.path())),
              HasSubstr("procedure.toml: cannot open: No such file or directory"));
  EXPECT_THROW(loadProcedure(folder_.path()), config::ConfigError);
  writeSound();
  write(path("en.md"), "# T\n## a: A\n![x](a.png)\n![y](../b.png)\n![z](text.png)\n");
  write(path("text.png"), "no picture");
  const std::string messages = messagesOf(readProcedureFolder(folder_.path()));
  EXPECT_THAT(messages, HasSubstr("en.md:3: there is no picture \"a.png\""));
  EXPECT_THAT(messages, HasSubstr("en.md:4: \"../b.png\" is not in the procedure's folder"));
  EXPECT_THAT(messages, HasSubstr("en.md:5: "));
}

TEST_F(ProcedureFolderTest, AMovieIsCheckedAndInTheHash) {
  writeSound();
  const auto messagesWith = [&](const std::string& movie) {
    write(path("procedure.toml"), kHead + "[[step]]\nid = \"a\"\nmovie = \"" + movie + "\"\n");
    return messagesOf(readProcedureFolder(folder_.path()));
  };
  support::writeAvMovie(path("turn.mkv"), {.size = {64, 36}, .frames = 15 * 25});
  EXPECT_EQ(messagesWith("turn.mkv"), "") << "15 s to the frame";
  const Procedure procedure = loadProcedure(folder_.path());
  EXPECT_THAT(procedure.files, ElementsAre("en.md", "procedure.toml", "turn.mkv"));
  EXPECT_EQ(procedure.steps[0].movie->size, (hal::FrameSize{64, 36}));
  support::writeAvMovie(path("turn.mkv"), {.size = {64, 36}, .frames = 50});
  EXPECT_NE(loadProcedure(folder_.path()).hash, procedure.hash) << "another movie";

  support::writeAvMovie(path("long.mkv"), {.size = {64, 36}, .frames = 15 * 25 + 2});
  EXPECT_THAT(messagesWith("long.mkv"),
              HasSubstr("procedure.toml:8: step[0].movie: \"long.mkv\" lasts longer than 15 s"));
  EXPECT_THAT(messagesWith("trun.mkv"),
              HasSubstr("there is no movie \"trun.mkv\" (did you mean \"turn.mkv\"?)"));
  EXPECT_THAT(messagesWith("../turn.mkv"), HasSubstr("is not in the procedure's folder"));
  write(path("text.mkv"), "no movie");
  EXPECT_THAT(messagesWith("text.mkv"), HasSubstr("is not in a supported movie format"));
  support::writeAvMovie(path("one.mkv"), {.frames = 1});
  EXPECT_THAT(messagesWith("one.mkv"), HasSubstr("\"one.mkv\" has a single frame"));
  std::filesystem::create_directory(path("folder"));
  EXPECT_THAT(messagesWith("folder"), HasSubstr("step[0].movie: "));
}

TEST_F(ProcedureFolderTest, MoviesAndPicturesHaveBounds) {
  writeSound();
  const auto messagesWith = [&](const std::string& movie) {
    write(path("procedure.toml"), kHead + "[[step]]\nid = \"a\"\nmovie = \"" + movie + "\"\n");
    return messagesOf(readProcedureFolder(folder_.path()));
  };
  support::writeAvMovie(path("m.mkv"), {.size = {256, 64}, .frames = 3});
  EXPECT_EQ(messagesWith("m.mkv"), "");
  for (const hal::FrameSize size : {hal::FrameSize{320, 64}, {64, 320}, {8192, 16}}) {
    support::writeAvMovie(path("m.mkv"), {.size = size, .frames = 3});
    EXPECT_THAT(messagesWith("m.mkv"),
                testing::AllOf(HasSubstr("\"m.mkv\" has " + std::to_string(size.width) + " × "),
                               HasSubstr("at most 4:1")));
  }
  support::writeAvMovie(path("m.mkv"), {.frames = 3});
  std::filesystem::resize_file(path("m.mkv"), kMostMovieFileBytes + 1);  // a hole in the file
  EXPECT_THAT(messagesWith("m.mkv"),
              testing::AllOf(HasSubstr("\"m.mkv\" has 65 MB"), HasSubstr("at most 64 MB")));

  writeSound();
  write(path("en.md"), "# T\n## a: A\n![x](wide.png)\n");
  ASSERT_TRUE(hal::writePng(
      path("wide.png"),
      hal::Image({.pixelFormat = hal::PixelFormat::kGrey8, .size = {8192, 16}}).view()));
  EXPECT_THAT(messagesOf(readProcedureFolder(folder_.path())),
              HasSubstr("en.md:3: \"wide.png\" has 8192 × 16 px"));
}

TEST_F(ProcedureFolderTest, ALinkOutOfTheFolderIsRefused) {
  const support::TemporaryFolder elsewhere;
  support::writeAvMovie(elsewhere.path() / "m.mkv", {.frames = 3});
  std::filesystem::create_symlink(elsewhere.path() / "m.mkv", path("file.mkv"));
  std::filesystem::create_symlink(elsewhere.path(), path("folder"));
  std::filesystem::create_symlink("loop.mkv", path("loop.mkv"));
  support::writeAvMovie(path("own.mkv"), {.frames = 3});
  std::filesystem::create_symlink("own.mkv", path("other.mkv"));
  writeSound();
  const auto messagesWith = [&](const std::string& movie) {
    write(path("procedure.toml"), kHead + "[[step]]\nid = \"a\"\nmovie = \"" + movie + "\"\n");
    return messagesOf(readProcedureFolder(folder_.path()));
  };
  EXPECT_THAT(messagesWith("file.mkv"), HasSubstr("a symbolic link leads out of it"));
  EXPECT_THAT(messagesWith("folder/m.mkv"), HasSubstr("a symbolic link leads out of it"));
  EXPECT_THAT(messagesWith("loop.mkv"), HasSubstr("Too many levels of symbolic links"));
  EXPECT_EQ(messagesWith("other.mkv"), "") << "a link within it";

  writeSound();
  std::filesystem::rename(path("en.md"), elsewhere.path() / "en.md");
  std::filesystem::create_symlink(elsewhere.path() / "en.md", path("en.md"));
  EXPECT_THAT(messagesOf(readProcedureFolder(folder_.path())),
              HasSubstr("a symbolic link leads out of it"));
}

TEST_F(ProcedureFolderTest, AFolderMayBeReachedByALink) {
  writeSound();
  support::writeAvMovie(path("m.mkv"), {.frames = 3});
  write(path("procedure.toml"), kHead + "[[step]]\nid = \"a\"\nmovie = \"m.mkv\"\n");
  const support::TemporaryFolder elsewhere;
  std::filesystem::create_symlink(folder_.path(), elsewhere.path() / "procedure");
  EXPECT_EQ(messagesOf(readProcedureFolder(elsewhere.path() / "procedure")), "");
}

TEST_F(ProcedureFolderTest, AModelOutsideOfTheFolderIsRefused) {
  writeSound();
  write(path("procedure.toml"),
        "name = \"p\"\nversion = \"1\"\nlanguages = [\"en\"]\n[model]\nsource = "
        "\"../m.glb\"\n[[step]]\n"
        "id = \"a\"\n");
  EXPECT_THAT(messagesOf(readProcedureFolder(folder_.path())),
              HasSubstr("procedure.toml:5: model.source: "));
  EXPECT_THAT(messagesOf(readProcedureFolder(folder_.path())),
              HasSubstr("is not in the procedure's folder"));
}

TEST_F(ProcedureFolderTest, AModelThatCannotBeReachedIsAMistake) {
  std::filesystem::create_symlink("m.glb", path("m.glb"));  // leads to itself
  writeProcedureOf("source = \"m.glb\"");
  EXPECT_THAT(messagesOf(readProcedureFolder(folder_.path())),
              HasSubstr("Too many levels of symbolic links"));
}

}  // namespace
}  // namespace pleinair::procedure
