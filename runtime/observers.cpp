#include "runtime/observer.h"
#include "runtime/render/run_pictures.h"

namespace scree {

std::vector<std::unique_ptr<Observer>> make_observers(const Case& c, const std::filesystem::path&, double dt) {
  std::vector<std::unique_ptr<Observer>> observers;
  for (const RunPicture& picture : c.output.pictures) observers.push_back(make_picture_observer(c, picture, dt));
  return observers;
}

}  // namespace scree
