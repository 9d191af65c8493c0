#include "runtime/panel_picture.h"

#include <algorithm>
#include <cmath>

#include "runtime/render/text.h"
#include "runtime/render/ticks.h"

namespace scree {

namespace {

constexpr Srgb kInk{25, 25, 30}, kFaintInk{95, 95, 105}, kPaper{255, 255, 255};
constexpr int kLetters = 17, kSmall = 14, kLine = 25, kMargin = 22, kTick = 5, kGap = 34, kBar = 18;
constexpr int kPixelsPerTick = 75;

struct Fonts {
  Font large{kLetters}, small{kSmall};
};

int most_ticks(int pixels) { return std::clamp(pixels / kPixelsPerTick, 2, 12); }

// Of what lies left of a panel's map: the tick labels of the axis up.
int left_of(const Panel& p, const Fonts& fonts) {
  int wide = 0;
  for (const std::string& label : ticks_between(p.bottom, p.top, most_ticks(p.height)).labels)
    wide = std::max(wide, fonts.small.width(label));
  return wide + kTick + 4;
}

int width_of(const Panel& p, const Fonts& fonts) {
  return std::max({left_of(p, fonts) + p.width, left_of(p, fonts) + fonts.small.width(p.title),
                   fonts.small.width(p.up) + p.width / 2});
}

void frame(Image& image, int x, int y, int w, int h) {
  image.fill(x - 1, y - 1, x + w + 1, y, kInk), image.fill(x - 1, y + h, x + w + 1, y + h + 1, kInk);
  image.fill(x - 1, y, x, y + h, kInk), image.fill(x + w, y, x + w + 1, y + h, kInk);
}

// The map's corner at (x, y).
void draw_panel(Image& image, const Panel& p, const Fonts& fonts, int x, int y) {
  for (int v = 0; v < p.height; ++v)
    for (int u = 0; u < p.width; ++u) image.set(x + u, y + v, p.map(u, v));
  frame(image, x, y, p.width, p.height);
  fonts.small.draw(image, x, y - kLine / 3, p.title, kInk);
  const Ticks across = ticks_between(p.left, p.right, most_ticks(p.width));
  for (size_t k = 0; k < across.values.size(); ++k) {
    const int at = x + static_cast<int>(std::lround((across.values[k] - p.left) / (p.right - p.left) * (p.width - 1)));
    image.fill(at, y + p.height, at + 1, y + p.height + kTick, kInk);
    fonts.small.draw(image, at - fonts.small.width(across.labels[k]) / 2, y + p.height + kTick + kSmall,
                     across.labels[k], kInk);
  }
  const Ticks up = ticks_between(p.bottom, p.top, most_ticks(p.height));
  for (size_t k = 0; k < up.values.size(); ++k) {
    const int at = y + static_cast<int>(std::lround((p.top - up.values[k]) / (p.top - p.bottom) * (p.height - 1)));
    image.fill(x - kTick, at, x, at + 1, kInk);
    fonts.small.draw(image, x - kTick - 3 - fonts.small.width(up.labels[k]), at + kSmall / 3, up.labels[k], kInk);
  }
  const std::string axes = p.across + (p.up.empty() ? "" : "  (up: " + p.up + ")");
  fonts.small.draw(image, x, y + p.height + kTick + kSmall + kLine, axes, kFaintInk);
}

int bar_labels(const ColourScale& scale, int height, const Fonts& fonts) {
  int wide = 0;
  for (const std::string& label : ticks_between(scale.min, scale.max, most_ticks(height)).labels)
    wide = std::max(wide, fonts.small.width(label));
  return wide;
}

void draw_bar(Image& image, const ColourScale& scale, const Fonts& fonts, int x, int y, int height) {
  for (int v = 0; v < height; ++v) {
    const double value = scale.max - (v + 0.5) / height * (scale.max - scale.min);
    image.fill(x, y + v, x + kBar, y + v + 1, colour_of(scale, value));
  }
  frame(image, x, y, kBar, height);
  const Ticks ticks = ticks_between(scale.min, scale.max, most_ticks(height));
  for (size_t k = 0; k < ticks.values.size(); ++k) {
    const double share = (scale.max - ticks.values[k]) / (scale.max - scale.min);
    const int at = y + static_cast<int>(std::lround(share * (height - 1)));
    image.fill(x + kBar, at, x + kBar + kTick, at + 1, kInk);
    fonts.small.draw(image, x + kBar + kTick + 3, at + kSmall / 3, ticks.labels[k], kInk);
  }
  fonts.small.draw(image, x, y - kLine / 3, scale.unit.empty() ? "1" : scale.unit, kInk);
}

}  // namespace

Image draw(const PanelPicture& picture) {
  const Fonts fonts;
  int tall = 0, wide = 0;
  for (const Panel& p : picture.panels) tall = std::max(tall, p.height), wide += width_of(p, fonts) + kGap;
  const int bar = std::min(tall, 420), top = kMargin + 3 * kLine + (picture.note.empty() ? 0 : kLine);
  wide += kBar + kTick + 3 + bar_labels(picture.scale, bar, fonts);
  wide = std::max({wide, fonts.large.width(picture.title), fonts.small.width(picture.note)}) + 2 * kMargin;
  Image image(wide, top + tall + kTick + kSmall + 2 * kLine + kMargin);
  image.fill(0, 0, image.width(), image.height(), kPaper);
  fonts.large.draw(image, kMargin, kMargin + kLetters, picture.title, kInk);
  if (!picture.note.empty()) fonts.small.draw(image, kMargin, kMargin + kLetters + kLine, picture.note, kFaintInk);
  int x = kMargin;
  for (const Panel& p : picture.panels) {
    draw_panel(image, p, fonts, x + left_of(p, fonts), top);
    x += width_of(p, fonts) + kGap;
  }
  draw_bar(image, picture.scale, fonts, x, top, bar);
  return image;
}

double nearly_largest(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace scree
