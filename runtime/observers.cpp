#include "runtime/observer.h"

namespace scree {

std::vector<std::unique_ptr<Observer>> make_observers(const Case&, const std::filesystem::path&, double) {
  std::vector<std::unique_ptr<Observer>> observers;
  return observers;
}

}  // namespace scree
