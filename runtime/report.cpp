#include "runtime/report.h"

#include <algorithm>
#include <map>

#include "runtime/case_error.h"
#include "runtime/results.h"

namespace scree {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDataMark = "@DATA@";

// JSON that may stand inside <script>: "</script>" and "<!--" cannot occur in it.
std::string for_html(ReportJson data) {
  data["version"] = SCREE_VERSION;
  const std::string json = data.dump(-1, ' ', false, ReportJson::error_handler_t::replace);
  std::string text;
  text.reserve(json.size());
  for (const char c : json) c == '<' ? text += "\\u003c" : text += c;
  return text;
}

}  // namespace

void write_page(const fs::path& page, const ReportJson& data) {
  const size_t mark = kReportPage.find(kDataMark);
  std::string text(kReportPage.substr(0, mark));
  text += for_html(data);
  text += kReportPage.substr(mark + kDataMark.size());
  write_file(page, text);
}

void require_run_folder(const fs::path& folder) {
  if (!fs::is_regular_file(folder / "case.toml"))
    throw CaseError({folder.string(), 0, 0}, "is not the results folder of a run: it has no case.toml");
}

PictureBudget shared_by(size_t runs) {
  PictureBudget budget;
  budget.count = std::max<size_t>(1, budget.count / std::max<size_t>(1, runs));
  budget.bytes /= std::max<size_t>(1, runs);
  return budget;
}

void write_report(const fs::path& page, const std::vector<fs::path>& folders) {
  const fs::path beside = page.parent_path().empty() ? "." : page.parent_path();
  ReportJson data = {{"title", fmt::format("{} runs compared", folders.size())}, {"runs", ReportJson::array()}};
  std::map<std::string, int> names;
  for (const fs::path& folder : folders) {
    data["runs"].push_back(run_data(folder, beside, shared_by(folders.size())));
    ++names[data["runs"].back()["name"]];
  }
  for (ReportJson& run : data["runs"])
    if (names[run["name"]] > 1) run["name"] = run["link"];
  if (folders.size() == 1) {
    const ReportJson& run = data["runs"][0];
    data["title"] = run.contains("case") && run["case"].contains("title") ? run["case"]["title"] : run["name"];
  }
  write_page(page, data);
}

}  // namespace scree
