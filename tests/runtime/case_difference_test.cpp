// Which changes of a case make it another run, and how they are named.
#include "runtime/case_difference.h"

#include <gtest/gtest.h>

#include "runtime/case_reader.h"
#include "runtime/case_writer.h"
#include "tests/runtime/case_text.h"

namespace scree {
namespace {

using testing::Folder;
using testing::kGoodCase;

std::string difference_by(const std::vector<std::string>& overrides) {
  const Folder folder;
  const std::string path = folder.write("good.toml", kGoodCase);
  return case_difference(read_case(path).understood, read_case(path, overrides).understood).value_or("");
}

TEST(CaseDifference, IsNoneForTheUnderstoodCaseReadBack) {
  const Folder folder;
  const Case c = read_case(folder.write("good.toml", kGoodCase));
  const Case again = read_case(folder.write("case.toml", write_case(c)));
  EXPECT_EQ(case_difference(c.understood, again.understood), std::nullopt);
}

TEST(CaseDifference, NamesTheKeyAndBothValues) {
  const std::string text = difference_by({"stage.drain.max_time=0.75"});
  EXPECT_NE(text.find("'stage.drain.max_time'"), std::string::npos) << text;
  EXPECT_NE(text.find("0.75"), std::string::npos) << text;
  EXPECT_NE(difference_by({"seed=12"}).find("'seed' was 7 and is now 12"), std::string::npos);
}

TEST(CaseDifference, NamesTheFirstOfSeveral) {
  const std::string text = difference_by({"stage.drain.max_time=0.75", "seed=12"});
  EXPECT_NE(text.find("'seed'"), std::string::npos) << text;
}

TEST(CaseDifference, IsNoneForWhatDoesNotChangeTheCourse) {
  EXPECT_EQ(difference_by({"title=another", "checkpoint.interval=3", "checkpoint.keep=9", "watch.max_overlap=0.2",
                           "output.final_vtk=false"}),
            "");
  EXPECT_EQ(difference_by({"output.fields.interval=0.01", "output.fields.write=[\"age\"]", "output.residence.bin=0.1"}),
            "");
}

TEST(CaseDifference, IsAnotherWayToMeasureResidence) {
  EXPECT_NE(difference_by({"output.residence.interval=0.01"}).find("'output.residence.interval'"), std::string::npos);
}

// Sums over other cells or moments cannot go on.
TEST(CaseDifference, IsAnotherWayToAverage) {
  EXPECT_NE(difference_by({"output.touch.cell=1e-3"}).find("'output.touch.cell'"), std::string::npos);
  EXPECT_NE(difference_by({"output.default_average=false"}).find("'output.default_average'"), std::string::npos);
}

TEST(CaseDifference, IsNoneForAnotherSpellingOfANumber) {
  EXPECT_EQ(case_difference("a = 3\n[b]\nc = 1\nd = 2\n", "a = 3.0  # default\n[b]\nd = 2\nc = 1\n"), std::nullopt);
}

TEST(CaseDifference, SeesKeysThatComeAndGo) {
  EXPECT_NE(case_difference("a = 3\n", "a = 3\nb = 4\n")->find("'b' = 4 is new"), std::string::npos);
  EXPECT_NE(case_difference("a = 3\nb = 4\n", "a = 3\n")->find("'b' = 4 is gone"), std::string::npos);
  EXPECT_NE(
      case_difference("[[stage]]\nkind = 'x'\n", "[[stage]]\nkind = 'x'\n[[stage]]\nkind = 'y'\n")->find("'stage'"),
      std::string::npos);
}

}  // namespace
}  // namespace scree
