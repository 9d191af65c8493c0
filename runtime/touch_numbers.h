// Numbers out of touch maps.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "runtime/touch_maps.h"

namespace scree {

// Over a set of cells, weighted by area, exposed cells only.
struct TouchMeans {
  double area = 0;                              // m2, exposed
  double dead = 0;                              // m2, never touched
  double out_of_reach = 0;                      // m2, where the smallest grain has no room
  double touched = 0;                           // m2 times share of the looks
  double contacts = 0, force = 0, rubbing = 0;  // sums over cells and looks: count, N, W
  uint64_t looks = 0;

  void add(double cell_area, TouchState state, const TouchSums& sums);
  void add(const TouchMeans& other);
  double dead_share() const { return area > 0 ? dead / area : std::nan(""); }
  double touched_share() const { return area > 0 ? touched / area : std::nan(""); }
  double mean_force() const { return contacts > 0 ? force / contacts : 0; }  // N a contact
  double contact_density() const { return per_area_and_look(contacts); }     // 1/m2
  double pressure() const { return per_area_and_look(force); }               // Pa
  double rubbing_per_area() const { return per_area_and_look(rubbing); }     // W/m2

 private:
  double per_area_and_look(double sum) const {
    return area > 0 && looks > 0 ? sum / (area * static_cast<double>(looks)) : 0;
  }
};

// Of the patch's cells for which pick(row, column) holds.
TouchMeans means_of(const TouchPatch& patch, const TouchSurface& surface, const TouchRecord& record,
                    const std::function<bool(uint32_t row, uint32_t column)>& pick);

bool looks_up(const TouchPatch& fibre, uint32_t column);  // the column is in the upper half

// For summary.json: fibres, their upper and lower halves, each wall.
nlohmann::json touch_summary(const Case& c, const TouchSurface& surface, const TouchRecord& record);

// A row a fibre and a face.
void write_touch_csv(const std::filesystem::path& path, const TouchSurface& surface, const TouchRecord& record);

}  // namespace scree
