#include <fstream>

#include <gmock/gmock.h>

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

}  // namespace
}  // namespace pleinair::procedure
