#include "pipeline/record/record_report.h"

#include <gmock/gmock.h>

#include "tests/unit/record/session_fixture.h"

namespace pleinair::record {
namespace {

using testing::HasSubstr;
using testing::Not;

using RecordReportTest = SessionFixture;

TEST_F(RecordReportTest, HasVerdictStepsValuesAndStills) {
  auto session = begin();
  work(*session);
  const auto procedure = procedureOf();
  const std::string html = htmlReport(checkRecordFile(path()).value(), procedure.get());
  EXPECT_THAT(html, HasSubstr("Signed off as completed by K. Öz. All 14 lines"));
  EXPECT_THAT(html, HasSubstr("2.5 mm: too high"));
  EXPECT_THAT(html, HasSubstr("class=\"failed\""));
  EXPECT_THAT(html, HasSubstr("<td>3. T</td>")) << "number and title";
  EXPECT_THAT(html, HasSubstr("<img src=\"work.stills/0007-d-check.png\""));
  EXPECT_THAT(html, HasSubstr(session->record().finalHash()));
  EXPECT_THAT(html, HasSubstr("@page { size: A4"));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
}

TEST_F(RecordReportTest, TextsOfTheRecordAreNoMarkup) {
  auto session = WorkSession::begin(procedureOf(), path(),
                                    {.operatorName = "<b>&\"x\"",
                                     .workOrder = "<script>alert(1)</script>",
                                     .language = "en\"><i>"},
                                    clock());
  ASSERT_TRUE(session);
  ASSERT_TRUE(session->signOff("<img src=x>"));
  const std::string html = htmlReport(checkRecordFile(path()).value(), nullptr);
  EXPECT_THAT(html, Not(HasSubstr("<script>")));
  EXPECT_THAT(html, Not(HasSubstr("<img src=x>")));
  EXPECT_THAT(html, Not(HasSubstr("\"><i>")));
  EXPECT_THAT(html, HasSubstr("&lt;b&gt;&amp;&quot;x&quot;"));
}

TEST_F(RecordReportTest, SaysWhatIsWrong) {
  { ASSERT_TRUE(begin()->answer(procedure::Done{})); }
  const std::string html = htmlReport(checkRecordFile(path()).value(), nullptr);
  EXPECT_THAT(html, HasSubstr("class=\"bad\">The record is not signed off"));
  EXPECT_THAT(htmlReport(checkRecord("nonsense\n"), nullptr), HasSubstr("class=\"bad\">Line 1 "));
}

}  // namespace
}  // namespace pleinair::record
