// report.html: one self-contained page that says what was simulated and what came out. The page itself is in
// runtime/report/ (its files are bundled into kReportPage when Scree is built); here its data is put into it.
#pragma once

#include <string_view>

#include "runtime/report_data.h"

namespace scree {

extern const std::string_view kReportPage;  // HTML with one mark where the data goes

// The page of one run, at folder/report.html; returns its path. Throws RunError if it cannot be written.
std::filesystem::path write_report(const std::filesystem::path& folder);

// A page that compares several runs. Throws RunError, and CaseError for a folder that holds no run.
void write_comparison(const std::filesystem::path& page, const std::vector<std::filesystem::path>& folders);

// `data`: {title, runs: [run_data(), ...], sweep?}. Throws RunError.
void write_page(const std::filesystem::path& page, const ReportJson& data);

// Throws CaseError if `folder` has no case.toml: it is not the folder of a run.
void require_run_folder(const std::filesystem::path& folder);

}  // namespace scree
