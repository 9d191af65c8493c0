#include "runtime/averages.h"
#include "runtime/field_files.h"
#include "runtime/observer.h"
#include "runtime/render/run_pictures.h"
#include "runtime/residence.h"
#include "runtime/touch_maps.h"

namespace scree {

std::vector<std::unique_ptr<Observer>> make_observers(const Case& c, const std::filesystem::path& out, double dt) {
  std::vector<std::unique_ptr<Observer>> observers;
  if (writes_fields(c.output.fields)) observers.push_back(std::make_unique<FieldFiles>(c, out, dt));
  if (c.output.residence.enabled) observers.push_back(std::make_unique<Residence>(c, dt));
  for (const AverageSettings& average : c.output.averages)
    observers.push_back(std::make_unique<Averages>(c, average, dt));
  if (c.output.touch.enabled) observers.push_back(std::make_unique<TouchMaps>(c, dt));
  for (const RunPicture& picture : c.output.pictures) observers.push_back(make_picture_observer(c, picture, dt));
  return observers;
}

}  // namespace scree
