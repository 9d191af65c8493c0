// report.html: one self-contained page that says what was simulated and what came out. The page itself is in
// runtime/report/ (its files are bundled into kReportPage when Scree is built); here its data is put into it.
#pragma once

#include <string_view>

#include "runtime/report_data.h"

namespace scree {

extern const std::string_view kReportPage;  // HTML with one mark where the data goes

inline constexpr const char* kReportFile = "report.html";  // in the folder of a run or a sweep

// The page of one run, or one that compares several. Throws RunError if it cannot be written.
void write_report(const std::filesystem::path& page, const std::vector<std::filesystem::path>& folders);

// The pictures that each of so many runs may bring.
PictureBudget shared_by(size_t runs);

// `data`: {title, runs: [run_data(), ...], sweep?}. Throws RunError.
void write_page(const std::filesystem::path& page, const ReportJson& data);

// Throws CaseError if `folder` has no case.toml: it is not the folder of a run.
void require_run_folder(const std::filesystem::path& folder);

}  // namespace scree
