#include "pipeline/digest/sha256.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace pleinair::digest {
namespace {

// FIPS 180-2, appendix B.
constexpr const char* kOfAbc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

TEST(Sha256, IsTheStandards) {
  EXPECT_EQ(hexOf(sha256("abc")), kOfAbc);
  EXPECT_EQ(hexOf(sha256("")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hexOf(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Sha256, PiecesAreAsTheWholeAndFinishBeginsAnew) {
  Sha256Stream stream;
  stream.add("a");
  stream.add("bc");
  EXPECT_EQ(hexOf(stream.finish()), kOfAbc);
  stream.add("abc");
  EXPECT_EQ(hexOf(stream.finish()), kOfAbc);
}

TEST(Sha256, OfFiles) {
  const support::TemporaryFolder folder;
  std::ofstream(folder.path() / "abc") << "abc";
  EXPECT_EQ(hexOfFile(folder.path() / "abc").value(), kOfAbc);
  EXPECT_EQ(hexOfFile(folder.path() / "none").error().kind, hal::ErrorKind::kNotFound);
  EXPECT_EQ(hexOfFile(folder.path()).error().kind, hal::ErrorKind::kInvalidInput);
}

}  // namespace
}  // namespace pleinair::digest
