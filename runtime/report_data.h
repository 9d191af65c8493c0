// What a report shows of one run: everything that its results folder holds, as JSON. Nothing in the folder is required:
// what is missing, unfinished or unreadable is left out, and the page leaves out the section that needs it.
#pragma once

#include <cstdint>
#include <filesystem>

#include <nlohmann/json.hpp>

namespace scree {

using ReportJson = nlohmann::ordered_json;

// How much of the pictures goes into the page itself.
struct PictureBudget {
  size_t count = 24;      // of each folder, evenly spread over its series
  uint64_t bytes = 40e6;  // of all folders together
};

// {name, link, path, summary?, case?, tables: {stem: {columns, data, every}}, pictures: [...], files: [...]}
//   link      the folder as seen from `page_folder`, for links
//   summary   summary.json; missing while the run goes on
//   case      case.toml as a tree
//   tables    the *.csv that the page shows (kTables), column by column, every n-th row if they are long
//   pictures  see report_pictures.h
//   files     [{file, bytes}], sorted, of the folder and what it holds
ReportJson run_data(const std::filesystem::path& folder, const std::filesystem::path& page_folder,
                    const PictureBudget& budget);

// A CSV file with one header line and '#' comments; fields that are no numbers stay text. null if it cannot be read.
ReportJson csv_columns(const std::filesystem::path& path);

}  // namespace scree
