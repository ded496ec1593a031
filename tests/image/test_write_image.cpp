#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>

#include "onmesh/base/error.h"
#include "onmesh/image/image_io.h"
#include "support/image_files.h"

namespace fs = std::filesystem;

using namespace onmesh;

TEST_CASE("a JPEG is written close to its values and without alpha only", "[write_image]") {
  const ImageFolder folder;
  Image image = make_image(64, 64, 3);
  for (Index i = 0; i < 64 * 64; ++i) {
    image.texel(i)[0] = float(i % 64) / 63;
    image.texel(i)[1] = float(i / 64) / 63;
    image.texel(i)[2] = i % 64 < 32 ? 0.25F : 0.75F;
  }
  write_image(folder / "a.jpg", image);
  const Image again = read_image(folder / "a.jpg");
  REQUIRE(again.channels == 3);
  double worst = 0, sum = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double error = std::abs(double(image.pixels[i]) - double(again.pixels[i]));
    worst = std::max(worst, error);
    sum += error;
  }
  CHECK(worst < 0.03);
  CHECK(sum / double(image.pixels.size()) < 0.005);
  Image with_alpha = make_image(8, 8, 4);
  with_alpha.alpha_channel = 3;
  CHECK_THROWS_AS(check_writable_image(folder / "b.jpg", with_alpha), InputError);
  CHECK_THROWS_AS(write_image(folder / "b.jpg", with_alpha), InputError);
  CHECK_THROWS_AS(check_writable_image(folder / "b.png", make_image(2, 2, 5)), InputError);
  CHECK_THROWS_WITH(check_writable_image(folder / "b.jpg", with_alpha),
                    Catch::Contains("b.jpg") && Catch::Contains("alpha"));
  CHECK(folder.files() == 1);
}

TEST_CASE("a target that cannot be written is refused and nothing is left behind",
          "[write_image]") {
  const ImageFolder folder;
  const Image image = noise(8, 8, 3);
  for (const std::string name : {"missing/a.png", "a.xyz", "a", "folder.png"}) {
    fs::create_directory(folder / "folder.png");
    INFO(name);
    CHECK_THROWS_AS(check_writable_image(folder / name, image), FileError);
    CHECK_THROWS_AS(write_image(folder / name, image), FileError);
    CHECK(folder.files() == 1);
  }
  CHECK_THROWS_AS(write_image(folder / "a.png", Image()), InputError);
  REQUIRE(mkfifo((folder / "pipe.png").c_str(), 0600) == 0);
  CHECK_THROWS_AS(write_image(folder / "pipe.png", image), FileError);
}

TEST_CASE("when the disk is full the target stays as it was", "[write_image]") {
  const ImageFolder folder;
  const Image image = noise(200, 200, 3);
  // A limit on file size fails writes the way a full disk does.
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  for (const std::string name : {"a.png", "a.jpg", "a.tif", "a.exr", "a.tga", "a.bmp", "a.sgi"}) {
    dump(folder / name, "precious");
    rlimit limit = before;
    limit.rlim_cur = 2000;
    setrlimit(RLIMIT_FSIZE, &limit);
    INFO(name);
    std::string message;
    try {
      write_image(folder / name, image);
    } catch (const FileError& error) {
      message = error.what();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    CHECK(message.find(name) != std::string::npos);
    CHECK(slurp(folder / name) == "precious");
    CHECK(folder.files() == 1);
    fs::remove(folder / name);
  }
  std::signal(SIGXFSZ, handler);
}

TEST_CASE("a link stays a link and permissions stay as they were", "[write_image]") {
  const ImageFolder folder;
  fs::create_directory(folder / "real");
  dump(folder / "real/a.png", "old");
  fs::permissions(folder / "real/a.png", fs::perms(0640));
  fs::create_symlink("real/a.png", folder / "a.png");
  const Image image = noise(8, 8, 3);
  write_image(folder / "a.png", image);
  CHECK(fs::is_symlink(folder / "a.png"));
  CHECK(fs::status(folder / "real/a.png").permissions() == fs::perms(0640));
  CHECK(read_image(folder / "real/a.png").width == 8);
  const mode_t mask = umask(027);
  write_image(folder / "new.png", image);
  umask(mask);
  CHECK(fs::status(folder / "new.png").permissions() == fs::perms(0640));
}

TEST_CASE("an EXR has its channels by name, in whatever order they are in memory",
          "[write_image]") {
  const ImageFolder folder;
  Image image = make_image(3, 2, 4);
  image.channel_names = {"z.Z", "B", "G", "R"};
  for (std::size_t k = 0; k < image.pixels.size(); ++k) image.pixels[k] = float(k);
  write_image(folder / "o.exr", image);
  const Image read = read_image(folder / "o.exr");
  for (std::size_t c = 0; c < 4; ++c) {
    const auto& names = image.channel_names;
    const auto own = std::find(names.begin(), names.end(), read.channel_names[c]) - names.begin();
    for (Index t = 0; t < 6; ++t) REQUIRE(read.texel(t)[c] == image.texel(t)[own]);
  }
}

TEST_CASE("writing over the file that was read works", "[write_image]") {
  const ImageFolder folder;
  write_image(folder / "a.tif", noise(50, 50, 4));
  Image image = read_image(folder / "a.tif");
  image.pixels[5] = 0.125F;
  write_image(folder / "a.tif", image);
  CHECK(same_bits(read_image(folder / "a.tif").pixels, image.pixels));
}
