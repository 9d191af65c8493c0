#include "runtime/sweep_results.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "runtime/case_difference.h"
#include "runtime/report.h"
#include "runtime/results.h"
#include "runtime/run_folder.h"

namespace scree {

namespace {

namespace fs = std::filesystem;

// Keys of summary.json that sweep.csv has as columns of the same name.
constexpr const char* kColumns[] = {"steady_mass_flow_kg_per_s",
                                    "steady_mass_flow_standard_error_kg_per_s",
                                    "mass_discharged_kg",
                                    "mass_retained_kg",
                                    "physical_time_s",
                                    "particles",
                                    "lost_particles",
                                    "wall_time_s",
                                    "state_hash"};

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string csv_cell(const ReportJson& summary, const char* key) {
  const auto at = summary.find(key);
  if (at == summary.end() || at->is_null()) return "";
  return at->is_string() ? csv_text(at->get<std::string>()) : at->dump();
}

std::string csv_row(const SweepPlan& plan, const SweepRun& run, const fs::path& folder) {
  std::vector<std::string> cells = {run.name};
  for (size_t p = 0; p < run.values.size(); ++p)
    cells.push_back(csv_text(plan.parameters[p].values[run.values[p]].text));
  const ReportJson summary = summary_in(folder);
  cells.push_back(run.seed ? std::to_string(*run.seed) : "");
  cells.push_back(status_of(run, folder));
  for (const char* key : kColumns) cells.push_back(summary.is_null() ? "" : csv_cell(summary, key));
  return fmt::format("{}\n", fmt::join(cells, ","));
}

std::string sweep_csv(const SweepPlan& plan, const fs::path& out) {
  std::vector<std::string> names = {"run"};
  for (const SweepParameter& p : plan.parameters) names.push_back(csv_text(p.label));
  names.insert(names.end(), {"seed", "status"});
  names.insert(names.end(), std::begin(kColumns), std::end(kColumns));
  std::string text = fmt::format("{}\n", fmt::join(names, ","));
  for (const SweepRun& run : plan.runs) text += csv_row(plan, run, out / run.name);
  return text;
}

ReportJson parameter_data(const SweepParameter& p) {
  ReportJson data = {{"label", p.label}, {"keys", p.keys}, {"values", ReportJson::array()}};
  for (const SweepValue& v : p.values)
    data["values"].push_back({{"text", v.text}, {"number", v.number ? ReportJson(*v.number) : ReportJson()}});
  return data;
}

ReportJson page_data(const SweepPlan& plan, const fs::path& out) {
  ReportJson data = {{"title", plan.title}, {"runs", ReportJson::array()}};
  ReportJson& sweep = data["sweep"];
  sweep = {{"parameters", ReportJson::array()}, {"seeds", plan.seeds}, {"runs", ReportJson::array()}};
  for (const SweepParameter& p : plan.parameters) sweep["parameters"].push_back(parameter_data(p));
  if (plan.reference)
    sweep["reference"] = {
        {"label", plan.reference->label}, {"value", plan.reference->value}, {"unit", plan.reference->unit}};
  for (const SweepCaption& caption : plan.captions) sweep["captions"][caption.chart] = caption.text;
  for (const SweepRun& run : plan.runs) {
    const fs::path folder = out / run.name;
    const bool has_results = fs::exists(folder / "summary.json");
    sweep["runs"].push_back({{"name", run.name},
                             {"values", run.values},
                             {"seed", run.seed ? ReportJson(*run.seed) : ReportJson()},
                             {"status", status_of(run, folder)},
                             {"run", has_results ? ReportJson(data["runs"].size()) : ReportJson()}});
    if (has_results) data["runs"].push_back(run_data(folder, out, shared_by(plan.runs.size())));
  }
  return data;
}

}  // namespace

ReportJson summary_in(const fs::path& folder) {
  std::ifstream stream(folder / "summary.json");
  ReportJson summary = ReportJson::parse(stream, nullptr, false);
  return summary.is_object() ? summary : ReportJson();
}

std::string status_of(const SweepRun& run, const fs::path& folder) {
  std::ifstream stream(folder / "case.toml");
  if (!stream) return "to do";
  std::ostringstream text;
  text << stream.rdbuf();
  if (const auto difference = case_difference(text.str(), run.understood))
    throw RunRefused(
        fmt::format("{} holds a run of another case than the sweep file describes now: {}. Undo the "
                    "change, name another folder with --out, or remove that run",
                    folder.string(), *difference));
  const ReportJson summary = summary_in(folder);
  return summary.is_null() ? "begun" : summary.value("status", "begun");
}

void write_sweep_results(const SweepPlan& plan, const fs::path& out) {
  write_file(out / "sweep.csv", sweep_csv(plan, out));
  write_page(out / kReportFile, page_data(plan, out));
}

}  // namespace scree
