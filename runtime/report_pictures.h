// The PNG files of a results folder that go into its report.
#pragma once

#include "runtime/report_data.h"

namespace scree {

inline constexpr const char* kPictureFolders[] = {"pictures", "averages", "touch", "residence"};

// [{folder, file, width, height, uri}] for the chosen ones (`uri`: the file itself as a data URI), then
// {folder, left_out: n} for each folder that holds more than the budget lets in.
ReportJson pictures_of(const std::filesystem::path& folder, const PictureBudget& budget);

}  // namespace scree
