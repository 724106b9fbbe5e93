#include "io/config.h"
#include "io/error.h"
#include "tests/unit/io/sample_rasters.h"

#include <cmath>

using namespace hsgm::io;
using namespace hsgm::io::samples;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;
using Catch::Matchers::StartsWith;

namespace {

const char* const kRun = R"(pair:
  left: left.tif
  right: {path: /data/right.tif, band: 2, nodata: 0, mask: mask.tif}
matcher:
  cost: census5x5   # not the default
  disparity: [-16, 64]
  p1: 24
run:
  memory: 80%
)";

/// Reads what `kRun` holds, as the pipeline would.
void read_run(ConfigDocument& document)
{
    ConfigSection root = document.root();
    ConfigSection pair = root.section("pair");
    pair.image("left");
    pair.image("right");
    ConfigSection matcher = root.section("matcher");
    matcher.choice("cost", "census7x7", {"census5x5", "census7x7"});
    matcher.range_or("disparity", "auto");
    matcher.integer("p1", 24, 1, 255);
    matcher.integer_or("levels", "auto", std::nullopt, 3, 10);
    matcher.flag("prune", true);
    ConfigSection run = root.section("run");
    run.byte_amount("memory", "80%");
    run.integer_or("tile_size", "auto", std::nullopt, 0);
}

ConfigSection section_of(const std::string& text)
{
    return ConfigDocument::parse(text, "run.yaml").root();
}

} // namespace

TEST_CASE("values are read as given and defaults fill the gaps")
{
    ConfigDocument document = ConfigDocument::parse(kRun, "cfg/run.yaml", "cfg");
    ConfigSection matcher = document.root().section("matcher");
    CHECK(matcher.choice("cost", "census7x7", {"census5x5", "census7x7"}) == "census5x5");
    CHECK(matcher.range_or("disparity", "auto") == std::pair{-16, 64});
    CHECK(matcher.integer("p1", 20) == 24);
    CHECK(matcher.integer("p2", 192) == 192);
    CHECK(matcher.number("weight", 0.5) == 0.5);
    CHECK(matcher.flag("prior", true));
    CHECK(matcher.text("mode", "hsgm") == "hsgm");
    CHECK_FALSE(matcher.integer_or("levels", "auto").has_value());
    CHECK_FALSE(document.root().section("absent").section("deeper").has("key"));
    CHECK(document.root().section("run").byte_amount("memory", "1GiB").share == 0.8);
}

TEST_CASE("an image is a path or a map, and paths start at the file's folder")
{
    ConfigDocument document = ConfigDocument::parse(kRun, "cfg/run.yaml", "cfg");
    ConfigSection pair = document.root().section("pair");
    const ImageSpec left = pair.image("left");
    CHECK(left.path == "cfg/left.tif");
    CHECK(left.band == 0);
    CHECK_FALSE(left.nodata.has_value());
    const ImageSpec right = pair.image("right");
    CHECK(right.path == "/data/right.tif");
    CHECK(right.band == 2);
    CHECK(right.nodata == 0.0);
    CHECK(right.mask == "cfg/mask.tif");
    ConfigSection other =
        section_of("a: /vsizip/x.zip/y.tif\nb: 'NETCDF:x.nc:z'\nc: {path: x, nodata: none}");
    CHECK(other.path("a") == "/vsizip/x.zip/y.tif");
    CHECK(other.path("b") == "NETCDF:x.nc:z");
    CHECK(std::isnan(other.image("c").nodata.value_or(0)));
    CHECK_THROWS_WITH(other.image("d"), Contains("'d' is missing") && Contains("path"));
    CHECK(other.path_or("folder", "result") == "result");
}

TEST_CASE("a wrong value is refused with place, name, what was found and what is allowed")
{
    ConfigSection s = section_of("n: 300\nt: fast\nlist: [1, x]\nmap: {a: 1}\nempty:\n"
                                 "r: [5, 1]\nx: 1.5\nbig: 99999999999\nnan: .nan");
    CHECK_THROWS_WITH(s.integer("n", 1, 1, 255),
                      Equals("run.yaml:1:4: 'n' is '300'; it must be a whole number from 1 to "
                             "255."));
    CHECK_THROWS_WITH(s.integer("t", 1),
                      Equals("run.yaml:2:4: 't' is 'fast'; it must be a whole number."));
    CHECK_THROWS_WITH(s.integer_or("t", "auto", {}, 0),
                      Contains("a whole number of at least 0 or 'auto'"));
    CHECK_THROWS_WITH(s.integer("x", 1), Contains("'1.5'"));
    CHECK_THROWS_WITH(s.integer("big", 1), Contains("'99999999999'"));
    CHECK_THROWS_WITH(s.number("nan", 1), Contains("it must be a number"));
    CHECK_THROWS_WITH(s.number("t", 1, 0.25), Contains("a number of at least 0.25"));
    CHECK_THROWS_WITH(s.flag("t", true), Contains("true or false"));
    CHECK_THROWS_WITH(s.choice("t", "a", {"a", "b"}),
                      Contains("'fast'; it must be one of a, b"));
    CHECK_THROWS_WITH(s.text("map", ""), StartsWith("run.yaml:4:6: 'map' is a section"));
    CHECK_THROWS_WITH(s.text("empty", "x"), StartsWith("run.yaml:5:1: 'empty' is empty"));
    CHECK_THROWS_WITH(s.numbers("list"), Contains("holds 'x'"));
    CHECK_THROWS_WITH(s.range_or("r", "auto"), Contains("[5, 1]") && Contains("or 'auto'"));
    CHECK_THROWS_WITH(s.range_or("n", "auto"), Contains("[min, max]"));
    CHECK_THROWS_WITH(s.bytes("t", "1GiB"), StartsWith("run.yaml:2:4: 't':"));
    CHECK_THROWS_WITH(s.section("n"), Contains("'n' is '300'; it must be a section"));
    CHECK_THROWS_WITH(s.sections("n"), Contains("list of sections"));
    CHECK_THROWS_WITH(s.required_text("gone"), StartsWith("run.yaml:1:1: 'gone' is missing"));
    CHECK_THROWS_WITH(s.fail("n", "clashes with 't'."), "run.yaml:1:4: 'n' clashes with 't'.");
    CHECK_THROWS_AS(s.fail("n", ""), ConfigError);
}

TEST_CASE("an unknown key is refused with the nearest known one")
{
    const auto refusal = [](const std::string& text) -> std::string {
        ConfigDocument document = ConfigDocument::parse(text, "run.yaml");
        read_run(document);
        try {
            document.refuse_unknown();
        } catch (const ConfigError& error) {
            return error.what();
        }
        return "";
    };
    const std::string pair = "pair: {left: a, right: b}\n";
    CHECK(refusal(pair).empty());
    CHECK(refusal(kRun).empty());
    CHECK(refusal(pair + "run:\n  tilesize: 512\n") ==
          "run.yaml:3:3: unknown key 'run.tilesize'; did you mean 'tile_size'?");
    CHECK_THAT(refusal(pair + "matchr: {}"), Contains("did you mean 'matcher'?"));
    CHECK_THAT(refusal(pair + "tile_size: 512"), Contains("did you mean 'run.tile_size'?"));
    CHECK_THAT(refusal(pair + "matcher: {zzzzzz: 1}"),
               Contains("known here: cost, disparity, p1, levels, prune"));
    CHECK_THAT(refusal("pair: {left: {path: a, bnad: 1}, right: b}"),
               Contains("'pair.left.bnad'; did you mean 'band'?"));
}

TEST_CASE("sections in lists and sections of free names are checked too")
{
    ConfigDocument document = ConfigDocument::parse(
        "pairs:\n  - {left: a}\n  - {lefft: b}\nimages: {north: {path: x}}", "run.yaml");
    ConfigSection root = document.root();
    std::vector<ConfigSection> pairs = root.sections("pairs");
    REQUIRE(pairs.size() == 2);
    CHECK(pairs[0].required_text("left") == "a");
    CHECK(pairs[1].text("left", "none") == "none");
    ConfigSection images = root.section("images");
    CHECK(images.keys() == std::vector<std::string>{"north"});
    CHECK(images.image("north").path == "x");
    CHECK_THROWS_WITH(document.refuse_unknown(),
                      Contains("run.yaml:3:6: unknown key 'pairs.1.lefft'"));
    CHECK(root.sections("absent").empty());
}

TEST_CASE("overrides win, reach new and listed places, and are named when wrong")
{
    ConfigDocument document = ConfigDocument::parse(kRun, "run.yaml");
    document.set("matcher.cost=census7x7");
    document.set("matcher.disparity", "[0, 32]");
    document.set("matcher.p1", "many");
    document.set("new.section.key", "5");
    document.set("matcher.disparity.1", "33");
    ConfigSection root = document.root();
    ConfigSection matcher = root.section("matcher");
    CHECK(matcher.text("cost", "") == "census7x7");
    CHECK(matcher.range_or("disparity", "auto") == std::pair{0, 33});
    CHECK_THROWS_WITH(matcher.integer("p1", 1),
                      StartsWith("--set matcher.p1: 'matcher.p1' is 'many'"));
    CHECK(root.section("new").section("section").integer("key", 0) == 5);
    CHECK_THROWS_WITH(document.set("pair.left.band", "2"), Contains("--set pair.left.band") &&
                                                               Contains("'left.tif'") &&
                                                               Contains("run.yaml:2:9"));
    CHECK_THROWS_WITH(document.set("matcher.disparity.7", "2"), Contains("leads nowhere"));
    CHECK_THROWS_WITH(document.set("matcher..cost", "2"), Contains("KEY=VALUE"));
    CHECK_THROWS_WITH(document.set("matcher.cost"), Contains("KEY=VALUE"));
    CHECK_THROWS_WITH(document.set("matcher.cost", "[1"), Contains("--set matcher.cost"));
}

TEST_CASE("an unknown override names itself")
{
    ConfigDocument document = ConfigDocument::parse(kRun, "run.yaml");
    document.set("matcher.cots=census7x7");
    read_run(document);
    CHECK_THROWS_WITH(document.refuse_unknown(),
                      StartsWith("--set matcher.cots: unknown key 'matcher.cots'; did you "
                                 "mean 'cost'?"));
}

TEST_CASE("the effective configuration is complete, marks changes, and reads back the same")
{
    ConfigDocument document = ConfigDocument::parse(kRun, "run.yaml", "/data/set");
    read_run(document);
    const std::string yaml = document.effective_yaml();
    CHECK_THAT(yaml, Contains("cost: census5x5  # default: census7x7"));
    CHECK_THAT(yaml, Contains("disparity: [-16, 64]  # default: auto"));
    CHECK_THAT(yaml, Contains("levels: auto\n"));
    CHECK_THAT(yaml, Contains("prune: true\n"));
    CHECK_THAT(yaml, Contains("left: /data/set/left.tif"));
    CHECK_THAT(yaml, Contains("mask: /data/set/mask.tif"));
    CHECK_THAT(yaml, Contains("memory: 80%"));
    ConfigDocument again = ConfigDocument::parse(yaml, "config.used.yaml", "/elsewhere");
    read_run(again);
    CHECK_NOTHROW(again.refuse_unknown());
    CHECK(again.effective_yaml() == yaml);
}

TEST_CASE("texts that look like something else survive the way through the effective file")
{
    const std::vector<std::string> texts{"",    "~", "null",       "a: b", "# no", "'", "\"",
                                         "- x", "ü", "two\nlines", "*x",   "%",    "@", " x "};
    for (const std::string& text : texts) {
        ConfigDocument document = ConfigDocument::empty("defaults");
        document.root().text("key", text);
        ConfigDocument again = ConfigDocument::parse(document.effective_yaml(), "again");
        INFO(document.effective_yaml());
        CHECK(again.root().text("key", "?") == text);
    }
}

TEST_CASE("a file that is no configuration is refused with line and column")
{
    const auto parse = [](const std::string& text) { ConfigDocument::parse(text, "run.yaml"); };
    CHECK_THROWS_AS(parse(""), ConfigError);
    CHECK_THROWS_WITH(parse(""), Contains("run.yaml") && Contains("empty"));
    CHECK_THROWS_WITH(parse("# only words\n"), Contains("empty"));
    CHECK_THROWS_WITH(parse("- a\n- b\n"), StartsWith("run.yaml:1:1:") && Contains("a list"));
    CHECK_THROWS_WITH(parse("a: 1\nb: [1, 2\n"), StartsWith("run.yaml:3:1:"));
    CHECK_THROWS_WITH(parse("a: 1\n\tb: 2\n"), StartsWith("run.yaml:2:"));
    CHECK_THROWS_WITH(parse("a: 1\nb: 2\na: 3\n"),
                      StartsWith("run.yaml:3:1: the key 'a' comes twice"));
    CHECK_THROWS_WITH(parse("a: {b: 1, b: 2}"), StartsWith("run.yaml:1:11:"));
    CHECK_THROWS_WITH(parse("a: 1\n---\nb: 2\n"), Contains("second document"));
    CHECK_THROWS_WITH(parse("a: &x [*x]\n"), Contains("run.yaml"));
    CHECK_THROWS_WITH(parse("[a, b]: 1\n"), Contains("a key must be a plain word"));
}

TEST_CASE("a file is loaded with its name in the messages and its folder for the paths")
{
    TemporaryFolder folder;
    put_bytes(folder / "run.yaml", kRun);
    ConfigDocument document = ConfigDocument::load(folder / "run.yaml");
    CHECK(document.folder() == folder.path());
    CHECK(document.root().section("pair").image("left").path == folder / "left.tif");
    CHECK_THROWS_WITH(document.root().section("matcher").integer("cost", 1),
                      StartsWith((folder / "run.yaml") + ":5:9:"));
    CHECK_THROWS_WITH(ConfigDocument::load(folder / "absent.yaml"), Contains("absent.yaml"));
    CHECK_THROWS_AS(ConfigDocument::load(folder.path()), ConfigError);
}

TEST_CASE("amounts of bytes understand their units and refuse what is none")
{
    CHECK(parse_bytes("4096") == 4096);
    CHECK(parse_bytes("8GiB") == 8ULL << 30);
    CHECK(parse_bytes("512 MiB") == 512ULL << 20);
    CHECK(parse_bytes("1.5K") == 1536);
    CHECK(parse_bytes("2GB") == 2000000000ULL);
    CHECK(parse_byte_amount("80%").of(1000) == 800);
    CHECK(parse_byte_amount("4K").of(1000) == 4096);
    for (const char* wrong :
         {"", "GiB", "-1", "8gib", "8 apples", "nan", "inf", "1e30", "80%"}) {
        CHECK_THROWS_AS(parse_bytes(wrong), ConfigError);
    }
    for (const char* wrong : {"0%", "101%", "-5%", "%"}) {
        CHECK_THROWS_AS(parse_byte_amount(wrong), ConfigError);
    }
}

TEST_CASE("values in force are listed by name, and files are told from words")
{
    ConfigDocument document = ConfigDocument::parse(
        "pair: {left: a.tif, right: {path: b.tif, mask: m.tif}}\nmatcher: {p2: 160}\n",
        "run.yaml", "/data");
    ConfigSection root = document.root();
    ConfigSection pair = root.section("pair");
    pair.image("left");
    pair.image("right");
    ConfigSection matcher = root.section("matcher");
    matcher.integer("p2", 192);
    matcher.text("cost", "census7x7");
    std::string found;
    for (const ConfigValue& value : document.effective_values()) {
        found += value.name + "=" + value.text + (value.is_file ? " file" : "") +
                 (value.is_image ? " image" : "") + "\n";
    }
    CHECK(found == "pair.left=/data/a.tif file image\n"
                   "pair.right.path=/data/b.tif file image\n"
                   "pair.right.band=auto\n"
                   "pair.right.mask=/data/m.tif file\n"
                   "matcher.p2=160\n"
                   "matcher.cost=census7x7\n");
}
