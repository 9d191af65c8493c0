#include "runtime/render/annotations.h"

#include <fmt/format.h>

#include "runtime/render/text.h"
#include "runtime/render/ticks.h"

namespace scree {

namespace {

constexpr Srgb kInk{25, 25, 30}, kFaintInk{95, 95, 105}, kPaper{250, 250, 250};
constexpr float kPaperCoverage = 0.82f;
constexpr int kSmallestLetters = 11;  // pixels: below, they are not legible
constexpr double kLettersPerSide = 44;
constexpr int kMostTicks = 6;

// Sizes that follow from the picture's, pixels.
struct Layout {
  explicit Layout(const Image& image)
      : letters(std::max(kSmallestLetters,
                         static_cast<int>(std::lround(std::min(image.width(), image.height()) / kLettersPerSide)))),
        margin(letters),
        line(letters * 3 / 2),
        stroke(std::max(1, letters / 12)) {}
  int letters, margin, line, stroke;
};

// A light ground, so that letters can be read whatever is behind them.
void paper(Image& image, const Layout& layout, int x0, int y0, int x1, int y1) {
  const int pad = layout.letters / 2;
  image.fill(x0 - pad, y0 - pad, x1 + pad, y1 + pad, kPaper, kPaperCoverage);
}

struct Label {
  int y;  // of its middle
  std::string text;
};

void draw_swatches(Image& image, const Layout& layout, const Font& font, const ColourScale& scale) {
  int wide = font.width(scale.quantity);
  for (const std::string& name : scale.categories) wide = std::max(wide, layout.line + font.width(name));
  const int rows = static_cast<int>(scale.categories.size()) + 1;
  const int x = image.width() - layout.margin - wide, y = (image.height() - rows * layout.line) / 2;
  paper(image, layout, x, y, x + wide, y + rows * layout.line);
  font.draw(image, x, y + layout.letters, scale.quantity, kInk);
  for (int k = 1; k < rows; ++k) {
    const int top = y + k * layout.line;
    image.fill(x, top, x + layout.letters, top + layout.letters, colour_of_category(static_cast<size_t>(k) - 1));
    font.draw(image, x + layout.line, top + layout.letters - layout.letters / 8,
              scale.categories[static_cast<size_t>(k) - 1], kInk);
  }
}

void draw_bar(Image& image, const Layout& layout, const Font& font, const ColourScale& scale) {
  const UnitPrefix prefix = prefix_for(std::max(std::abs(scale.min), std::abs(scale.max)), scale.unit);
  const Ticks ticks = ticks_between(scale.min / prefix.factor, scale.max / prefix.factor, kMostTicks);
  const std::string unit = prefix.prefix + scale.unit;
  const std::string title = unit.empty() ? scale.quantity : scale.quantity + ", " + unit;
  const int height = image.height() * 2 / 5, bar = layout.letters, gap = layout.letters / 2;
  int labels = 0;
  for (const std::string& label : ticks.labels) labels = std::max(labels, font.width(label));
  const int wide = std::max(bar + gap + labels, font.width(title));
  const int x = image.width() - layout.margin - wide, top = (image.height() - height) / 2;
  paper(image, layout, x, top - 2 * layout.line, x + wide, top + height + gap);
  font.draw(image, x, top - layout.line + layout.letters / 4, title, kInk);
  for (int y = 0; y < height; ++y) {
    const double share = 1 - (y + 0.5) / height;
    image.fill(x, top + y, x + bar, top + y + 1, colour_of(scale, scale.min + share * (scale.max - scale.min)));
  }
  for (size_t k = 0; k < ticks.values.size(); ++k) {
    const double share = (ticks.values[k] * prefix.factor - scale.min) / (scale.max - scale.min);
    const int y = top + static_cast<int>(std::lround((1 - share) * (height - 1)));
    image.fill(x + bar, y - layout.stroke / 2, x + bar + gap / 2, y - layout.stroke / 2 + layout.stroke, kInk);
    font.draw(image, x + bar + gap, y + layout.letters * 3 / 8, ticks.labels[k], kInk);
  }
}

void draw_scale(Image& image, const Layout& layout, const Font& font, const ScaleBar& scale) {
  const int x = layout.margin, y = image.height() - layout.margin, tall = std::max(2, layout.letters / 5);
  const int text = font.width(scale.label);
  paper(image, layout, x, y - tall - layout.line, x + std::max(scale.pixels, text), y);
  image.fill(x, y - tall, x + scale.pixels, y, kInk);
  font.draw(image, x + std::max(0, (scale.pixels - text) / 2), y - tall - layout.letters / 2, scale.label, kInk);
}

void draw_title(Image& image, const Layout& layout, const Font& font, const Annotations& annotations) {
  const Font small(std::max(kSmallestLetters, layout.letters * 3 / 4));
  const std::string time = std::isnan(annotations.time) ? "" : fmt::format("t = {:.4f} s", annotations.time);
  const int x = layout.margin;
  int y = layout.margin, wide = std::max(font.width(time), small.width(annotations.title));
  paper(image, layout, x, y, x + wide,
        y + (time.empty() ? 0 : layout.line) + (annotations.title.empty() ? 0 : layout.line));
  if (!time.empty()) font.draw(image, x, y += layout.letters, time, kInk), y += layout.line - layout.letters;
  small.draw(image, x, y + layout.letters, annotations.title, kFaintInk);
}

}  // namespace

ScaleBar scale_bar(const Camera& camera, int width, int height) {
  const double pixel = camera.height / height;  // m
  ScaleBar scale;
  scale.length = round_down(0.25 * width * pixel);
  scale.pixels = static_cast<int>(std::lround(scale.length / pixel));
  const double mm = 1e3 * scale.length;
  scale.label = mm < 1     ? fmt::format("{:g} µm", 1e3 * mm)
                : mm < 1e3 ? fmt::format("{:g} mm", mm)
                           : fmt::format("{:g} m", scale.length);
  return scale;
}

void annotate(Image& image, const Annotations& annotations) {
  const Layout layout(image);
  const Font font(layout.letters);
  if (annotations.colours && annotations.colours->categories.empty())
    draw_bar(image, layout, font, *annotations.colours);
  if (annotations.colours && !annotations.colours->categories.empty())
    draw_swatches(image, layout, font, *annotations.colours);
  if (annotations.scale) draw_scale(image, layout, font, *annotations.scale);
  if (!annotations.title.empty() || !std::isnan(annotations.time)) draw_title(image, layout, font, annotations);
}

}  // namespace scree
