#include "runtime/report.h"

#include <algorithm>

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

fs::path write_report(const fs::path& folder) {
  ReportJson run = run_data(folder, folder, PictureBudget{});
  ReportJson data;
  data["title"] = run.contains("case") ? run["case"].value("title", "") : "";
  data["runs"].push_back(std::move(run));
  const fs::path page = folder / "report.html";
  write_page(page, data);
  return page;
}

void write_comparison(const fs::path& page, const std::vector<fs::path>& folders) {
  ReportJson data;
  data["title"] = fmt::format("{} runs compared", folders.size());
  PictureBudget budget;
  budget.count = std::max<size_t>(1, budget.count / folders.size()), budget.bytes /= folders.size();
  for (const fs::path& folder : folders) {
    require_run_folder(folder);
    data["runs"].push_back(run_data(folder, page.parent_path().empty() ? "." : page.parent_path(), budget));
  }
  write_page(page, data);
}

}  // namespace scree
