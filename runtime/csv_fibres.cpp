#include "runtime/csv_fibres.h"

#include "runtime/csv_table.h"

namespace scree {
namespace {

const std::vector<std::string> kEnds{"x0", "y0", "z0", "x1", "y1", "z1"};
const std::vector<std::string> kColumns{"x0", "y0", "z0", "x1", "y1", "z1", "diameter"};

std::vector<Fibre> read_rows(CsvTable& table, const std::string& path) {
  int column[6];
  for (size_t i = 0; i < 6; ++i) column[i] = table.require(kEnds[i]);
  const int diameter = table.column("diameter");
  std::vector<Fibre> fibres;
  while (table.next()) {
    double v[6];
    for (int i = 0; i < 6; ++i) v[i] = table.number(column[i], kPosition);
    Fibre& fibre = fibres.emplace_back(Fibre{{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}}, 0});
    if (norm(fibre.axis.b - fibre.axis.a) < kShortestFibre)
      table.fail(column[0], fmt::format("the fibre has no length, its ends must be {:g} m apart", kShortestFibre));
    if (diameter >= 0) fibre.diameter = table.number(diameter, kFibreDiameter);
  }
  if (fibres.empty()) throw CaseError({path, table.line(), 1}, "the file has no fibres below its header");
  return fibres;
}

}  // namespace

std::vector<Fibre> read_fibres_csv(const std::string& path) {
  CsvTable table(path, kColumns);
  return read_rows(table, path);
}

std::vector<Fibre> read_fibres_csv(const std::string& path, std::string text) {
  CsvTable table(path, std::move(text), kColumns);
  return read_rows(table, path);
}

}  // namespace scree
