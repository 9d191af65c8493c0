#include "runtime/render/run_pictures.h"

#include <chrono>
#include <cstring>

#include "runtime/case_moments.h"
#include "runtime/case_sections.h"
#include "runtime/particle_fields.h"
#include "runtime/render/case_scene.h"
#include "runtime/render/picture.h"

namespace scree {

namespace {

// Unless the case says otherwise: a run should not wait for its pictures.
constexpr const char* kRunSize = "960x540";
constexpr int kRunSamples = 4;

// A frame of no particles with every field that a run has.
ParticleFrame empty_frame() {
  ParticleFrame frame;
  for (const ParticleFieldForm& form : particle_field_forms()) frame.fields.push_back({form.name, form.components, {}});
  return frame;
}

// see(number) for each of the column's, one after the other.
void each_number(const ParticleSnapshot::Column& column, const auto& see) {
  const auto read = [&]<class T>(T) {
    for (size_t at = 0; at < column.values.capacity(); at += sizeof(T)) {
      T value;
      std::memcpy(&value, &column.values[at], sizeof(T));
      see(value);
    }
  };
  if (column.type.kind == ElementType::Kind::real)
    column.type.size == 8 ? read(double{}) : read(float{});
  else
    column.type.size == 1 ? read(uint8_t{}) : column.type.size == 2 ? read(int16_t{}) : read(uint32_t{});
}

template <class To>
std::vector<To> values_in(const ParticleSnapshot::Column& column) {
  std::vector<To> values;
  values.reserve(column.size());
  each_number(column, [&](auto value) { values.push_back(static_cast<To>(value)); });
  return values;
}

std::vector<Vec3> positions_in(const ParticleSnapshot::Column& points) {
  std::vector<Vec3> positions(points.size() / 3);
  size_t k = 0;
  each_number(points, [&](auto x) {
    Vec3& at = positions[k / 3];
    (k % 3 == 0 ? at.x : k % 3 == 1 ? at.y : at.z) = static_cast<double>(x), ++k;
  });
  return positions;
}

std::string one_of_names(TableReader& t, const char* key, const std::string& what, const char* fallback,
                         const std::vector<std::string>& names) {
  t.text(key, fallback);
  return names[t.index(key, what, names)];
}

void read_camera(TableReader& t, CameraRequest& camera) {
  camera.name = one_of_names(t, "camera", "camera", "front", camera_names());
  if (camera.name == "junction" && t.has("point")) camera.point = t.vec3("point", kPosition);
  if (camera.name != "free") return;
  camera.position = t.vec3("position", kPosition), camera.target = t.vec3("target", kPosition);
  camera.up = t.vec3("up", Range{}, camera.up);
  if (t.at_most_one_of({"field_of_view", "width"}) == "width")
    camera.width = t.number("width", kLength);
  else
    camera.field_of_view_deg = t.number("field_of_view", between(1, 150, "degrees"), camera.field_of_view_deg);
}

// What the command line refuses becomes an error of the key.
auto checked(const TableReader& t, const std::string& key, const auto& make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    t.fail(key, error.what());
  }
}

RunPicture read_picture(TableReader& t, const std::vector<RunPicture>& before) {
  RunPicture picture;
  PictureRequest& request = picture.request;
  picture.name = new_name(t, "picture", names_of(before));
  read_camera(t, request.camera);
  request.colour = one_of_names(t, "colour", "quantity", "speed", run_quantities());
  if (t.has("range")) {
    const std::vector<double> range = t.numbers("range", Range{}, 2);
    if (range[1] <= range[0]) t.fail("range", fmt::format("{} must be [least, most]", t.shown("range")));
    request.range = ValueRange{range[0], range[1]};
  }
  if (t.has("cut")) request.cuts = t.texts("cut");
  for (const std::string& cut : request.cuts) checked(t, "cut", [&] { return parse_cut(cut, {}); });
  if (request.camera.name == "free") checked(t, "camera", [&] { return make_camera(request.camera, {}, 1); });
  request.walls = t.choice<WallStyle>(
      "walls", {{"transparent", WallStyle::transparent}, {"faint", WallStyle::faint}, {"hidden", WallStyle::hidden}},
      "transparent");
  t.text("size", kRunSize);
  request.size = checked(t, "size", [&] { return parse_size(t.text("size")); });
  request.samples = static_cast<int>(t.whole("samples", between(1, 64, "rays a pixel"), kRunSamples));
  picture.moments = read_moments(t);
  t.finish();
  return picture;
}

class PictureObserver final : public Observer {
 public:
  PictureObserver(const Case& c, const RunPicture& picture, double dt)
      : picture_(picture), schedule_(picture.moments, dt) {
    try {
      make_camera(picture.request.camera, camera_subject(c, c.domain), 1);
    } catch (const std::invalid_argument& error) {
      throw CaseError({c.source}, fmt::format("output.picture.{}: {}", picture.name, error.what()));
    }
  }

  std::string name() const override { return "picture_" + picture_.name; }
  const Schedule& schedule() const override { return schedule_; }

  void look(const RunView& run) override {
    const auto start = std::chrono::steady_clock::now();
    const std::filesystem::path folder = run.out / "pictures";
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw RunError(fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
    write_png(folder / fmt::format("{}_{:.6f}.png", picture_.name, run.engine.time()),
              draw_picture(run.c, frame_now(run.c, run.engine, picture_.request.colour), picture_.request, run.solid));
    ++drawn_;
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  nlohmann::json summary() const override { return {{"pictures", drawn_}, {"seconds", seconds_}}; }

 private:
  RunPicture picture_;
  Schedule schedule_;
  uint64_t drawn_ = 0;
  double seconds_ = 0;
};

}  // namespace

std::vector<std::string> run_quantities() { return quantities_of(empty_frame()); }

ParticleFrame frame_now(const Case& c, const Engine& engine, const std::string& quantity) {
  const ParticleFrame known = empty_frame();
  std::vector<std::string> fields;
  if (const ParticleField* field = field_of(known, quantity)) fields.push_back(field->name);
  ParticleFrame frame;
  frame.time = engine.time();
  // Each column goes as soon as it is read: of ten million grains they are 330 MB.
  for (ParticleSnapshot::Column& given : ParticleSnapshot(c, engine, fields).take()) {
    const ParticleSnapshot::Column column = std::move(given);
    if (column.name == "id") continue;
    if (column.name == "Points")
      frame.positions = positions_in(column);
    else if (column.name == "radius")
      frame.radii = values_in<float>(column);
    else
      frame.fields.push_back(
          {column.name, static_cast<int>(std::max<uint64_t>(column.components, 1)), values_in<float>(column)});
  }
  return frame;
}

void read_pictures(TableReader& output, std::vector<RunPicture>& pictures) {
  for (TableReader& t : output.tables("picture")) pictures.push_back(read_picture(t, pictures));
}

std::unique_ptr<Observer> make_picture_observer(const Case& c, const RunPicture& picture, double dt) {
  return std::make_unique<PictureObserver>(c, picture, dt);
}

}  // namespace scree
