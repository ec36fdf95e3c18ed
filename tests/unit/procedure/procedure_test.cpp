#include "pipeline/procedure/procedure.h"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>

#include "pipeline/procedure/node_names.h"
#include "tests/unit/procedure/procedure_texts.h"

namespace pleinair::procedure {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

TEST(Procedure, ReadsEverything) {
  MemorySources sources;
  sources.texts["en.md"] =
      "# Service\n"
      "## drain: Drain the oil\nUnscrew the *plug*.\nSlowly.\n\n- one\n- two\n![The "
      "plug](plug.png)\n"
      "## gap: Measure the gap\n? Gap at the top\n"
      "## look: Compare\n";
  sources.texts["de.md"] =
      "# Wartung\n## drain: Öl ablassen\nSchraube lösen.\n## gap: Spalt messen\n? Spalt oben\n"
      "## look: Vergleichen\n";
  const ProcedureReading reading = readProcedure(R"(
name = "service"
version = "1.2"
languages = ["en", "de"]
[model]
source = "builtin:gearbox"
[tools]
hex = { en = "hex key", de = "Inbus" }
[warnings]
oil = { level = "caution", en = "Hot", de = "Heiß" }
[[step]]
id = "drain"
parts = ["plug", "bolt_*"]
removes = ["plug"]
tools = ["hex"]
warnings = ["oil"]
torque = "25 ± 2 Nm"
movie = "plug.mp4"
[[step]]
id = "gap"
check = { kind = "value", unit = "mm", min = 0.1, max = 0.3 }
goto = { low = "gap", high = "end" }
[[step]]
id = "look"
fits = ["plug"]
check = { kind = "compare", template = "plug.png" }
next = "end"
)",
                                                 "p.toml", sources);
  EXPECT_EQ(messagesOf(reading), "");
  const Procedure& procedure = reading.procedure;
  EXPECT_EQ(procedure.name, "service");
  EXPECT_EQ(procedure.version, "1.2");
  EXPECT_EQ(procedure.title.at("de"), "Wartung");
  ASSERT_EQ(procedure.steps.size(), 3U);
  const Step& drain = procedure.steps[0];
  EXPECT_EQ(drain.line, 12);
  EXPECT_THAT(drain.parts, ElementsAre(0, 2, 3));
  EXPECT_THAT(drain.removes, ElementsAre(0));
  EXPECT_EQ(drain.torque->newtonMetres, 25.0);
  EXPECT_EQ(drain.movie->file, "plug.mp4");
  EXPECT_EQ(drain.movie->size, (hal::FrameSize{320, 180}));
  EXPECT_EQ(procedure.warnings[drain.warnings.at(0)].level, WarningLevel::kCaution);
  EXPECT_EQ(procedure.tools[drain.tools.at(0)].name.at("de"), "Inbus");
  EXPECT_THAT(drain.next, ElementsAre(Pair(Outcome::kDone, 1U)));
  EXPECT_EQ(drain.text.at("en").title, "Drain the oil");
  EXPECT_EQ(plainText(drain.text.at("en").body), "Unscrew the plug. Slowly.\n• one\n• two");
  ASSERT_EQ(drain.text.at("en").pictures.size(), 1U);
  EXPECT_EQ(drain.text.at("en").pictures[0].caption, "The plug");
  const Step& gap = procedure.steps[1];
  EXPECT_EQ(limitsText(*gap.check), "0.1 … 0.3 mm");
  EXPECT_EQ(gap.text.at("de").question, "Spalt oben");
  EXPECT_THAT(gap.next, ElementsAre(Pair(Outcome::kOk, 2U), Pair(Outcome::kLow, 1U),
                                    Pair(Outcome::kHigh, kEnd)));
  EXPECT_EQ(procedure.steps[2].check->comparison, "plug.png");
  EXPECT_THAT(procedure.steps[2].parts, ElementsAre(0)) << "what it moves is what it shows";
  EXPECT_THAT(procedure.files, ElementsAre("de.md", "en.md", "plug.mp4", "plug.png"));
  EXPECT_EQ(procedure.text(0, "fr").title, "Drain the oil") << "the default language";
}

/// A mistake in a step's keys, and the message that it gives.
struct StepMistake {
  const char* keys;
  const char* message;
};

class StepMistakes : public testing::TestWithParam<StepMistake> {};

TEST_P(StepMistakes, AreSaidWithFileLineAndRemedy) {
  const std::string step = "[tools]\nhex = { en = \"hex key\" }\n[[step]]\nid = \"a\"\n" +
                           std::string(GetParam().keys) + "\n";
  EXPECT_THAT(messagesOf(readSteps(step, {"a"}, "")), HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Of, StepMistakes,
    testing::Values(
        StepMistake{"parts = [\"covr\"]",
                    "p.toml:10: step[0].parts: the model has no node \"covr\" (did you mean "
                    "\"cover\"?), allowed: plug, cover, bolt_1, bolt_2, shaft"},
        StepMistake{"parts = [\"blot_*\"]",
                    "the model has no node \"blot_*\" (did you mean \"bolt_*\"?)"},
        StepMistake{"parts = [\"bolt\"]",
                    "the model has no node \"bolt\" (did you mean \"bolt*\"?)"},
        StepMistake{
            "tools = [\"hax\"]",
            "p.toml:10: step[0].tools: found \"hax\" (did you mean \"hex\"?), allowed: hex"},
        StepMistake{"torque = \"25\"",
                    "p.toml:10: step[0].torque: \"25\" has no unit, allowed: such as"},
        StepMistake{"torque = 25", "found 25 (integer)"},
        StepMistake{"next = \"b\"",
                    "p.toml:10: step[0].next: there is no step \"b\", allowed: a, end"},
        StepMistake{"goto = { no = \"end\" }", "step[0].goto: needs a check"},
        StepMistake{"check = \"yes_no\"\ngoto = { low = \"end\" }",
                    "step[0].goto.low: unknown outcome, allowed: yes, no"},
        StepMistake{"check = \"yes_no\"\nnext = \"end\"\ngoto = { yes = \"a\" }",
                    "contradicts next"},
        StepMistake{"check = \"yes_no\"", "en.md:2: step \"a\" has a check but no question"},
        StepMistake{
            "check = { kind = \"value\", unit = \"mm\", min = 3, max = 1 }",
            "p.toml:10: step[0].check.min: found 3, which is not below max = 1, allowed: min "
            "= 1, max = 3"},
        StepMistake{"check = { kind = \"value\", unit = \"mm\", min = 3, max = 3 }",
                    "found 3, which is not below max = 3, allowed: a min below max"},
        StepMistake{"check = { kind = \"value\", unit = \"mm\", min = 0,1 }",
                    "allowed: a decimal point: 0.1, not 0,1"},
        StepMistake{"check = \"yesno\"",
                    "step[0].check: found \"yesno\" (did you mean \"yes_no\"?), "
                    "allowed: yes_no, value, photo, compare"},
        StepMistake{"check = \"value\"", "\"value\" needs its unit and limits"},
        StepMistake{"parts = [\"cover#2\"]",
                    "the model has no node \"cover#2\": its nodes \"cover\" are 1, from #1 on"},
        StepMistake{"apart = { cover = 101.0 }", "step[0].apart.cover: found 101 metres"},
        StepMistake{"check = { kind = \"value\", unit = \"mn\", min = 3 }",
                    "step[0].check.unit: found \"mn\""},
        StepMistake{"check = { kind = \"value\", unit = \"mm\" }", "allowed: min, max, or both"},
        StepMistake{"check = { kind = \"value\", min = 1 }", "step[0].check.unit: missing"},
        StepMistake{"check = { kind = \"compare\", template = \"no.png\" }",
                    "p.toml:10: step[0].check.template: there is no picture \"no.png\""},
        StepMistake{"check = { kind = \"yes_no\", min = 1 }", "step[0].check.min: unknown key"},
        StepMistake{"movie = \"no.mp4\"", "p.toml:10: step[0].movie: there is no movie \"no.mp4\""},
        StepMistake{"movie = 5",
                    "step[0].movie: found 5 (integer), allowed: a movie in the folder"},
        StepMistake{"chek = \"photo\"", "step[0].chek: unknown key (did you mean \"check\"?)"},
        StepMistake{"[[step]]\nid = \"a\"",
                    "p.toml:11: step[1].id: \"a\" is the step at line 9 already"},
        StepMistake{"[[step]]\nid = \"end\"", "\"end\" is reserved"},
        StepMistake{"[[step]]\nid = \"No good\"", "step[1].id: found \"No good\""}));

TEST(LikelyMistakes, ArePlacedAndSayWhatWouldBeRight) {
  MemorySources sources;
  sources.texts["en.md"] = "# T\n## a: Open\nTurn it.\n## b: Look\n";
  sources.texts["de.md"] = "# T\n## a: Open\nTurn it.\n## b: Look\n";
  std::string toml = kHead +
                     "[tools]\nhex = { en = \"hex\", de = \"hex\" }\n"
                     "[[step]]\nid = \"a\"\n[[step]]\nid = \"b\"\n";
  toml.replace(toml.find("[\"en\"]"), 6, "[\"en\", \"de\"]");
  const ProcedureReading reading = readProcedure(toml, "p.toml", sources);
  EXPECT_EQ(messagesOf(reading), "");
  std::string warnings;
  for (const auto& each : reading.warnings) warnings += std::string(each.what()) + "\n";
  EXPECT_EQ(warnings,
            "p.toml:7: tools.hex: no step names it, allowed: tools of a step, or no such line\n"
            "en.md: nothing stands below the heading of b, allowed: what to do there, a picture, "
            "or a question\n"
            "de.md: nothing stands below the heading of b, allowed: what to do there, a picture, "
            "or a question\n"
            "de.md: says the same as en.md, allowed: the texts in \"de\"\n");
}

TEST(ProcedureMistakes, OneOfAnotherKindHidesNoStepThatIsNeverReached) {
  const std::string messages = messagesOf(
      readSteps("[[step]]\nid = \"a\"\ntools = [\"x\"]\nnext = \"end\"\n[[step]]\nid = \"b\"\n",
                {"a", "b"}, ""));
  EXPECT_THAT(messages, HasSubstr("step[0].tools"));
  EXPECT_THAT(messages, HasSubstr("\"b\" is never reached"));
}

TEST(ProcedureMistakes, EveryMistakeIsListed) {
  const std::string messages = messagesOf(
      readSteps("[[step]]\nid = \"a\"\ntools = [\"x\"]\n[[step]]\nid = \"b\"\nparts = [\"y\"]\n",
                {"a", "c"}, "? What?"));
  EXPECT_THAT(messages, HasSubstr("step[0].tools"));
  EXPECT_THAT(messages, HasSubstr("step[1].parts"));
  EXPECT_THAT(messages, HasSubstr("en.md:4: heading: there is no step \"c\""));
  EXPECT_THAT(messages, HasSubstr("en.md: has no text for step \"b\", allowed: \"## b: Title\""));
  EXPECT_THAT(messages, HasSubstr("en.md:2: step \"a\" has a question but no check"));
}

TEST(ProcedureMistakes, AllOfAStepAreListed) {
  const std::string messages = messagesOf(
      readSteps("[[step]]\nid = \"a\"\nparts = [\"y\"]\ntools = [\"x\"]\ntorque = \"5\"\n"
                "check = { kind = \"value\", unit = \"mm\" }\ngoto = { high = \"end\" }\n",
                {"a"}));
  for (const char* key : {"parts", "tools", "torque", "check.min"}) {
    EXPECT_THAT(messages, HasSubstr(std::string("step[0].") + key));
  }
  EXPECT_EQ(std::ranges::count(messages, '\n'), 4)
      << "what follows from them is none: " << messages;
}

TEST(ProcedureMistakes, UnknownKeysAreToldBesideOthers) {
  const std::string messages = messagesOf(
      readSteps("[[step]]\nid = \"a\"\nparts = [\"y\"]\nmotoin = \"turn\"\ncheck = "
                "\"nope\"\nnext = \"end\"\n[[step]]\nid = \"b\"\ntorqe = \"5 Nm\"\n[tolls]\n",
                {"a", "b"}));
  EXPECT_THAT(messages, HasSubstr("step[0].motoin: unknown key (did you mean \"motion\"?)"));
  EXPECT_THAT(messages, HasSubstr("step[1].torqe: unknown key (did you mean \"torque\"?)"));
  EXPECT_THAT(messages, HasSubstr("tolls: unknown key (did you mean \"tools\"?)"));
  EXPECT_THAT(messages, HasSubstr("step[0].parts"));
  EXPECT_THAT(messages, HasSubstr("step[0].check"));
  EXPECT_EQ(std::ranges::count(messages, '\n'), 6)
      << "the sixth: step b has a question but no check; next is no unknown key: " << messages;
}

TEST(Procedure, AStepsPartsMoveAlongTheAxisThatItSays) {
  const ProcedureReading reading =
      readSteps("[[step]]\nid = \"a\"\naxis = \"-y\"\n[[step]]\nid = \"b\"\n", {"a", "b"}, "");
  ASSERT_EQ(messagesOf(reading), "");
  EXPECT_EQ(reading.procedure.steps[0].axis, glm::dvec3(0.0, -1.0, 0.0));
  EXPECT_EQ(reading.procedure.steps[1].axis, glm::dvec3(0.0, 0.0, 1.0));
  const std::string messages =
      messagesOf(readSteps("[[step]]\nid = \"a\"\naxis = \"up\"\n", {"a"}, ""));
  EXPECT_THAT(messages, testing::ContainsRegex("p.toml:[0-9]+: step\\[0\\].axis: "));
  EXPECT_THAT(messages, HasSubstr("-x"));
}

TEST(Procedure, TellsNodesOfOneNameApart) {
  class Twins : public MemorySources {
   public:
    hal::Result<std::shared_ptr<const scene::Model>> model(const scene::ModelSource&) override {
      return modelWithParts({"piston", "rod", "piston", "ring#1"});
    }
  } sources;
  sources.texts["en.md"] = "# T\n## a: A\n## b: B\n";
  const auto read = [&](const std::string& a, const std::string& b) {
    return readProcedure(kHead + "[[step]]\nid = \"a\"\nparts = [" + a +
                             "]\n[[step]]\nid = \"b\"\nparts = [" + b + "]\n",
                         "p.toml", sources);
  };
  const ProcedureReading reading = read("\"piston\", \"ring#1\"", "\"piston#2\"");
  EXPECT_EQ(messagesOf(reading), "");
  EXPECT_THAT(reading.procedure.steps[0].parts, ElementsAre(0, 2, 3));
  EXPECT_THAT(reading.procedure.steps[1].parts, ElementsAre(2));
  const std::string messages = messagesOf(read("\"piston#3\"", "\"rod#0\""));
  EXPECT_THAT(messages, HasSubstr("step[0].parts: the model has no node \"piston#3\""));
  EXPECT_THAT(messages, HasSubstr("step[1].parts: the model has no node \"rod#0\""));
}

TEST(Procedure, NamesPartsAsStepsWould) {
  const auto model = modelWithParts({"piston", "rod", "piston", "bolt", "bolt"});
  const auto names = [&](const std::vector<std::size_t>& parts) {
    return namesOfParts(*model, parts);
  };
  EXPECT_THAT(names({0, 2, 3, 4}), ElementsAre("piston", "bolt"));
  EXPECT_THAT(names({1, 2, 4}), ElementsAre("rod", "piston#2", "bolt#2"));
  EXPECT_THAT(partsNamed(*model, names({2})[0]), ElementsAre(2));
}

/// An array below a table's head belongs to the table.
TEST(ProcedureMistakes, StepsBelowATableAreSaidToBeInIt) {
  const std::string messages = messagesOf(readSteps("step = [{ id = \"a\" }]\n", {"a"}, ""));
  EXPECT_THAT(messages, HasSubstr("p.toml:6: model.step: unknown key"));
  EXPECT_THAT(messages, HasSubstr("step: missing, allowed: at least one [[step]]"));
}

TEST(ProcedureMistakes, AWrongIdHidesNoOthers) {
  const std::string messages = messagesOf(readSteps(
      "[[step]]\nid = \"No good\"\nparts = [\"y\"]\n[[step]]\nid = \"b\"\ntools = [\"x\"]\n"
      "[[step]]\nid = \"b\"\ntorque = \"5\"\n",
      {"No good", "b"}, ""));
  for (const char* key :
       {"step[0].id", "step[0].parts", "step[1].tools", "step[2].id: \"b\" is", "step[2].torque"}) {
    EXPECT_THAT(messages, HasSubstr(key));
  }
  EXPECT_EQ(std::ranges::count(messages, '\n'), 5) << "the texts are right: " << messages;
}

TEST(ProcedureMistakes, OfTexts) {
  MemorySources sources;
  sources.texts["en.md"] = "lost words\n## a: A\n![x](gone.png)\n![broken\n## a: A\n## b\n";
  sources.texts["fr.md"] = "# T\n";
  const std::string messages =
      messagesOf(readProcedure(kHead + "[[step]]\nid = \"a\"\n", "p.toml", sources));
  EXPECT_THAT(messages, HasSubstr("en.md:1: title: missing"));
  EXPECT_THAT(messages, HasSubstr("en.md:1: text: stands before the first step"));
  EXPECT_THAT(messages, HasSubstr("en.md:3: there is no picture \"gone.png\""));
  EXPECT_THAT(messages, HasSubstr("en.md:4: picture: is not complete"));
  EXPECT_THAT(messages, HasSubstr("en.md:5: heading: step \"a\" has its text at line 2 already"));
  EXPECT_THAT(messages, HasSubstr("en.md:6: heading: \"b\" has no title"));
  EXPECT_THAT(messages, HasSubstr("fr.md: languages has no \"fr\""));
}

TEST(ProcedureMistakes, OfLanguages) {
  MemorySources sources;
  sources.texts["en.md"] = "# T\n## a: A\n";
  const std::string body =
      "name = \"p\"\nversion = \"1\"\nlanguages = [\"en\", \"de\"]\n[model]\nsource = "
      "\"builtin:gearbox\"\n[tools]\nhex = { en = \"hex key\" }\n[[step]]\nid = \"a\"\n";
  const std::string messages = messagesOf(readProcedure(body, "p.toml", sources));
  EXPECT_THAT(messages, HasSubstr("p.toml:7: tools.hex.de: missing, allowed: the text in \"de\""));
  EXPECT_THAT(messages, HasSubstr("de.md: missing, allowed: the texts of the language \"de\""));
  EXPECT_THAT(messagesOf(readProcedure("languages = [\"english\"]", "p.toml", sources)),
              HasSubstr("p.toml:1: languages: found \"english\""));
  EXPECT_THAT(messagesOf(readProcedure("languages = [\"en\", \"en\"]", "p.toml", sources)),
              HasSubstr("\"en\" is there twice"));
  EXPECT_THAT(messagesOf(readProcedure("version = ", "p.toml", sources)), HasSubstr("not TOML"));
}

}  // namespace
}  // namespace pleinair::procedure
