// Pixels come back from every format as they should, and pictures show what they must.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/report.h"
#include "decode.h"
#include "image/compare.h"
#include "image/decode_jpeg.h"
#include "image/display.h"
#include "image/encode.h"
#include "image/write_image.h"
#include "support/temporary_directory.h"

namespace motes {
namespace {

using testing::HasSubstr;

constexpr double never_stopped = 1;

std::string contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Premultiplied noise, of a size that is no multiple of anything.
Framebuffer noise(int width = 37, int height = 23) {
  Framebuffer framebuffer(width, height);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0, 1);
  for (std::size_t i = 0; i < framebuffer.rgba.size(); i += 4) {
    const float alpha = unit(random);
    for (std::size_t c = 0; c < 3; ++c) framebuffer.rgba[i + c] = alpha * unit(random);
    framebuffer.rgba[i + 3] = alpha;
  }
  return framebuffer;
}

Framebuffer one_pixel(float r, float g, float b, float alpha) {
  Framebuffer framebuffer(1, 1);
  framebuffer.rgba = {r, g, b, alpha};
  return framebuffer;
}

using Rgb = std::vector<std::uint8_t>;

TEST(Display, EncodesAsSrgbOverTheBackground) {
  EXPECT_EQ(to_display(one_pixel(0, 0, 0, 0), 0.97, {1, 0, 0.18F}).rgb, (Rgb{255, 0, 118}));
  // 0.25 + 0.5 * 0.5 = 0.5, 0.5 * 1, and 0.1 + 0: sRGB 0.7354, 0.7354 and 0.3492.
  EXPECT_EQ(to_display(one_pixel(0.25F, 0, 0.1F, 0.5F), 0.97, {0.5F, 1, 0}).rgb,
            (Rgb{188, 188, 89}));
}

TEST(Display, ShowsAStoppedRayAsOpaque) {
  const Color white{1, 1, 1};
  // 0.49 / 0.98 = 0.5; had it not stopped, the background would shine through.
  EXPECT_EQ(to_display(one_pixel(0.49F, 0, 0, 0.98F), 0.97, white).rgb, (Rgb{188, 0, 0}));
  EXPECT_NE(to_display(one_pixel(0.49F, 0, 0, 0.98F), 0.99, white).rgb, (Rgb{188, 0, 0}));
  // A ray stops where its opacity exceeds the bound, not where it meets it.
  EXPECT_EQ(to_display(one_pixel(0, 0, 0, 0.5F), 0.5, white).rgb, (Rgb{188, 188, 188}));
}

TEST(Display, ClampsWhatNoScreenShows) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(to_display(one_pixel(nan, infinity, -3, 1), never_stopped, {}).rgb, (Rgb{0, 255, 0}));
}

TEST(Display, EveryChannelIsRoundedToTheNearest) {
  // Of the floats from where all is 0 up to 1, one in so many.
  constexpr std::uint32_t stride = 211;
  std::vector<float> channels;
  for (auto bits = std::bit_cast<std::uint32_t>(0x1p-14F);
       bits < std::bit_cast<std::uint32_t>(1.0F); bits += stride) {
    channels.push_back(std::bit_cast<float>(bits));
  }
  Framebuffer framebuffer(static_cast<int>(channels.size() / 3), 1);
  for (std::size_t i = 0; i < framebuffer.num_pixels(); ++i) {
    std::copy_n(&channels[3 * i], 3, &framebuffer.rgba[4 * i]);
    framebuffer.rgba[4 * i + 3] = 1;
  }
  const DisplayImage image = to_display(framebuffer, never_stopped, {});
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const auto linear = static_cast<double>(channels[i]);
    ASSERT_EQ(image.rgb[i], std::lround(255 * linear_to_srgb(linear))) << linear;
  }
}

TEST(Png, ComesBackExactly) {
  const DisplayImage image = to_display(noise(), 0.97, {0.2F, 0.3F, 0.4F});
  EXPECT_EQ(decode_png(encode_png(image)), image);
  std::atomic<bool> cancel = false;
  EXPECT_EQ(encode_png(image, &cancel), encode_png(image));
  cancel = true;
  EXPECT_THROW(encode_png(image, &cancel), Cancelled);
}

TEST(Jpeg, ComesBackNearly) {
  // A smooth picture: JPEG is not for noise.
  Framebuffer framebuffer(64, 48);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      float* pixel = framebuffer.pixel(x, y);
      pixel[0] = static_cast<float>(x) / 64;
      pixel[1] = static_cast<float>(y) / 48;
      pixel[3] = 1;
    }
  }
  const DisplayImage image = to_display(framebuffer, 0.97, {});
  const DisplayImage back = decode_jpeg(encode_jpeg(image));
  ASSERT_EQ(back.width, 64);
  ASSERT_EQ(back.height, 48);
  int worst = 0;
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    worst = std::max(worst, std::abs(int{image.rgb[i]} - int{back.rgb[i]}));
  }
  EXPECT_LE(worst, 12);
  EXPECT_THROW(decode_jpeg(""), Error);
  EXPECT_THROW(decode_jpeg("no JPEG"), Error);
}

TEST(Jpeg, RefusesWhatItCannotHold) {
  const DisplayImage wide = to_display(Framebuffer(65501, 1), 0.97, {});
  EXPECT_THROW(encode_jpeg(wide), Error);
}

TEST(Exr, ComesBackExactly) {
  const Framebuffer framebuffer = noise();
  EXPECT_EQ(decode_exr(encode_exr(framebuffer)), framebuffer);
}

TEST(Npy, HoldsHeaderAndFloats) {
  const TemporaryDirectory directory;
  const Framebuffer framebuffer = noise();
  write_image(directory / "a.npy", framebuffer, 0.97, {});
  const std::string bytes = contents(directory / "a.npy");
  ASSERT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t header = 10 + std::size_t{static_cast<unsigned char>(bytes[8])} +
                             256 * std::size_t{static_cast<unsigned char>(bytes[9])};
  EXPECT_EQ(header % 64, 0U);
  EXPECT_EQ(bytes[header - 1], '\n');
  EXPECT_THAT(bytes.substr(10, header - 10),
              HasSubstr("{'descr': '<f4', 'fortran_order': False, 'shape': (23, 37, 4), }"));
  Framebuffer back(37, 23);
  ASSERT_EQ(bytes.size() - header, back.rgba.size() * 4);
  std::memcpy(back.rgba.data(), bytes.data() + header, bytes.size() - header);
  EXPECT_EQ(back, framebuffer);
}

TEST(WriteImage, TakesTheFormatFromTheName) {
  EXPECT_EQ(image_format("a.PNG"), ImageFormat::png);
  EXPECT_EQ(image_format("a.b.jpeg"), ImageFormat::jpeg);
  EXPECT_EQ(image_format("x/a.exr"), ImageFormat::exr);
  EXPECT_EQ(image_format("a.npy"), ImageFormat::npy);
  for (const char* name : {"a", "a.gif", "png", ".png", "a.png/"}) {
    EXPECT_THROW(image_format(name), Error) << name;
  }
}

TEST(WriteImage, WritesEveryFormat) {
  const TemporaryDirectory directory;
  const Framebuffer framebuffer = noise();
  const Color background{0.5F, 0, 0};
  const DisplayImage shown = to_display(framebuffer, 0.5, background);
  for (const char* name : {"a.png", "a.jpg", "a.exr"}) {
    write_image(directory / name, framebuffer, 0.5, background);
  }
  EXPECT_EQ(decode_png(contents(directory / "a.png")), shown);
  EXPECT_EQ(decode_jpeg(contents(directory / "a.jpg")).width, 37);
  EXPECT_EQ(decode_exr(contents(directory / "a.exr")), framebuffer);
  EXPECT_EQ(directory.num_entries(), 3U);
}

TEST(CompareImages, FindsTheWorstPixel) {
  const Framebuffer a = noise();
  Framebuffer b = a;
  b.pixel(5, 7)[2] += 0.5F;
  b.pixel(6, 7)[0] -= 0.25F;
  const ImageDifference difference = compare_images(a, b);
  EXPECT_NEAR(difference.max, 0.5, 1e-6);
  EXPECT_EQ(difference.worst_x, 5);
  EXPECT_EQ(difference.worst_y, 7);
  EXPECT_EQ(difference.compared, a.num_pixels());
  const double channels = 4. * 37 * 23;
  EXPECT_NEAR(difference.rms, std::sqrt((0.25 + 0.0625) / channels), 1e-6);

  std::vector<unsigned char> skip(a.num_pixels(), 0);
  skip[7 * 37 + 5] = 1;
  const ImageDifference masked = compare_images(a, b, skip);
  EXPECT_NEAR(masked.max, 0.25, 1e-6);
  EXPECT_EQ(masked.compared, a.num_pixels() - 1);
}

TEST(CompareImages, NaNIsNeverAlike) {
  const Framebuffer a = one_pixel(std::numeric_limits<float>::quiet_NaN(), 0, 0, 0);
  EXPECT_TRUE(std::isinf(compare_images(a, a).max));
  EXPECT_TRUE(std::isinf(compare_images(a, a).rms));
}

TEST(CompareImages, PeakSignalToNoiseIsInDecibels) {
  const DisplayImage a{2, 1, {0, 10, 20, 30, 40, 50}};
  EXPECT_EQ(peak_signal_to_noise(a, a), std::numeric_limits<double>::infinity());
  // All off by 25.5, a tenth of the range, would be 20 dB; here two of six are off by 30 and 40.
  const DisplayImage b{2, 1, {30, 10, 20, 30, 40, 10}};
  EXPECT_NEAR(peak_signal_to_noise(a, b), 20 * std::log10(255 / std::sqrt(2500. / 6)), 1e-12);
}

}  // namespace
}  // namespace motes
