// What goes into a report: everything a folder holds, nothing that breaks the page.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "runtime/base64.h"
#include "runtime/report.h"
#include "runtime/report_pictures.h"
#include "tests/runtime/case_text.h"

namespace scree {
namespace {

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(ReportData, base64_as_in_rfc_4648) {
  const std::pair<const char*, const char*> examples[] = {{"", ""},
                                                          {"f", "Zg=="},
                                                          {"fo", "Zm8="},
                                                          {"foo", "Zm9v"},
                                                          {"foob", "Zm9vYg=="},
                                                          {"fooba", "Zm9vYmE="},
                                                          {"foobar", "Zm9vYmFy"},
                                                          {"\xff\xfe\xfd", "//79"}};
  for (const auto& [bytes, text] : examples) {
    EXPECT_EQ(base64(bytes), text);
    EXPECT_EQ(from_base64(text), bytes);
  }
  for (const char* foreign : {"Zg=", "Z?==", "Zm9", "=m8=", "Zm 9"}) EXPECT_EQ(from_base64(foreign), std::nullopt);
}

TEST(ReportData, a_table_is_its_columns_and_text_stays_text) {
  const testing::Folder folder;
  const std::string path = folder.write("t.csv", "# a comment\nplace, kg\nnode 1, 1e-3\nwall,2\n");
  const ReportJson t = csv_columns(path);
  EXPECT_EQ(t["columns"], (ReportJson{"place", "kg"}));
  EXPECT_EQ(t["data"], (ReportJson{{"node 1", "wall"}, {1e-3, 2.0}}));
}

TEST(ReportData, a_long_table_is_thinned_evenly_and_keeps_its_ends) {
  const testing::Folder folder;
  std::string text = "x\n";
  for (int k = 0; k <= 20000; ++k) text += std::to_string(k) + "\n";
  const ReportJson t = csv_columns(folder.write("t.csv", text));
  EXPECT_EQ(t["rows"], 20001);
  const ReportJson& x = t["data"][0];
  ASSERT_LE(x.size(), 4001u);
  EXPECT_EQ(x[0], 0.0);
  EXPECT_EQ(x[1], t["every"]);
  EXPECT_EQ(x.back(), 20000.0);
}

TEST(ReportData, half_a_row_at_the_end_of_a_killed_run_is_left_out) {
  const testing::Folder folder;
  const ReportJson t = csv_columns(folder.write("t.csv", "a,b\n1,2\n3"));
  EXPECT_EQ(t["data"], (ReportJson{{1.0}, {2.0}}));
  EXPECT_TRUE(csv_columns(folder.write("empty.csv", "")).is_null());
  EXPECT_TRUE(csv_columns(folder.path("none.csv")).is_null());
}

TEST(ReportData, a_folder_with_nothing_readable_in_it_still_makes_a_page) {
  const testing::Folder folder;
  folder.write("run/case.toml", "this is = = not TOML");
  folder.write("run/summary.json", "{\"status\": ");
  folder.write("run/pictures/half.png", "\x89PNG");
  folder.write("run/mass_flow.csv", "");
  write_report(folder.path("run/report.html"), {folder.path("run")});
  const ReportJson run = run_data(folder.path("run"), folder.path("run"), {});
  EXPECT_FALSE(run.contains("case"));
  EXPECT_FALSE(run.contains("summary"));
  EXPECT_TRUE(text_of(folder.path("run/report.html")).ends_with("</html>\n"));
}

TEST(ReportData, runs_of_one_name_are_told_apart_by_their_folders) {
  const testing::Folder folder;
  for (const char* run : {"a/demo", "b/demo", "other"})
    folder.write(std::string(run) + "/case.toml", "title = \"x\"\n");
  write_report(folder.path("page.html"), {folder.path("a/demo"), folder.path("b/demo/"), folder.path("other")});
  const std::string page = text_of(folder.path("page.html"));
  for (const char* name : {"\"name\":\"a/demo\"", "\"name\":\"b/demo\"", "\"name\":\"other\""})
    EXPECT_NE(page.find(name), std::string::npos) << name;
}

TEST(ReportData, nothing_in_the_data_ends_the_script_that_holds_it) {
  const testing::Folder folder;
  write_page(folder.path("page.html"), {{"title", "</script><!--<script>"}, {"runs", ReportJson::array()}});
  const std::string page = text_of(folder.path("page.html"));
  const size_t data = page.find("id=\"data\">");
  EXPECT_EQ(page.substr(data + 10, page.find("</script>", data) - data - 10).find('<'), std::string::npos);
}

TEST(ReportData, text_that_is_no_utf8_does_not_stop_the_report) {
  const testing::Folder folder;
  folder.write("run/case.toml", "title = \"x\"\n");
  folder.write("run/residence.csv", "place,kg\n\xff\xfe,1\n");
  EXPECT_NO_THROW(write_report(folder.path("run/report.html"), {folder.path("run")}));
}

TEST(ReportData, the_page_refers_to_no_other_file) {
  for (const char* reference : {"src=\"http", "href=\"http", "url(", "@import", "fetch("})
    EXPECT_EQ(kReportPage.find(reference), std::string_view::npos) << reference;
  EXPECT_EQ(kReportPage.find("@DATA@"), kReportPage.rfind("@DATA@")) << "one mark for the data";
  EXPECT_NE(kReportPage.find("@DATA@"), std::string_view::npos);
}

TEST(ReportData, pictures_are_taken_within_the_budget) {
  const testing::Folder folder;
  const std::string png = std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x07\0\0\0\x05", 24) + std::string(76, 'x');
  for (int k = 0; k < 10; ++k) folder.write(fmt::format("pictures/front_{:02}.png", k), png);
  for (int k = 0; k < 10; ++k) folder.write(fmt::format("pictures/side_{:02}.png", k), png);
  PictureBudget few;
  few.count = 4;
  const ReportJson chosen = pictures_of(folder.path("."), few);
  std::vector<std::string> files;
  for (const ReportJson& p : chosen) files.push_back(p.value("file", ""));
  EXPECT_EQ(files, (std::vector<std::string>{"front_00.png", "front_09.png", "side_00.png", "side_09.png", ""}));
  EXPECT_EQ(chosen.back()["left_out"], 16);
  EXPECT_EQ(chosen[0]["width"], 7);
  EXPECT_EQ(chosen[0]["height"], 5);
  PictureBudget small;
  small.bytes = 350;
  EXPECT_EQ(pictures_of(folder.path("."), small).back()["left_out"], 17);
}

}  // namespace
}  // namespace scree
