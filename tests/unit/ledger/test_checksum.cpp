#include "io/error.h"
#include "pipeline/ledger/checksum.h"
#include "pipeline/ledger/fingerprint.h"
#include "tests/unit/io/sample_rasters.h"

#include "tests/catch.h"

using namespace hsgm::ledger;
using hsgm::io::samples::put_bytes;
using hsgm::io::samples::TemporaryFolder;

namespace {

std::string sha256(const std::string& text)
{
    Sha256 sum;
    sum.add(std::as_bytes(std::span(text)));
    return sum.hex();
}

std::string quick(const std::vector<std::uint8_t>& values)
{
    Checksum sum;
    sum.add_values(std::span<const std::uint8_t>(values));
    return sum.hex();
}

} // namespace

TEST_CASE("SHA-256 agrees with the published examples")
{
    // FIPS 180-4 and its example file.
    CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
          "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    CHECK(sha256(std::string(1'000'000, 'a')) ==
          "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("SHA-256 does not depend on how the bytes are cut")
{
    const std::string text(300, 'x');
    for (const std::size_t piece : {1U, 7U, 63U, 64U, 65U, 299U}) {
        Sha256 sum;
        for (std::size_t at = 0; at < text.size(); at += piece) {
            const auto rest = std::span(text).subspan(at);
            sum.add(std::as_bytes(rest.first(std::min(piece, rest.size()))));
        }
        CHECK(sum.hex() == sha256(text));
    }
}

TEST_CASE("the SHA-256 of a file is that of its bytes")
{
    const TemporaryFolder folder;
    put_bytes(folder / "abc", "abc");
    CHECK(sha256_of_file(folder / "abc") == sha256("abc"));
    CHECK_THROWS_AS(sha256_of_file(folder / "nothing"), hsgm::io::StorageError);
}

TEST_CASE("the quick checksum sees every bit, order and length")
{
    std::vector<std::uint8_t> values(37);
    std::vector<std::string> sums{quick(values), quick({}), quick({0}), quick({0, 0})};
    for (std::size_t i = 0; i < values.size(); ++i) {
        for (int bit = 0; bit < 8; ++bit) {
            values[i] ^= static_cast<std::uint8_t>(1U << bit);
            sums.push_back(quick(values));
            values[i] ^= static_cast<std::uint8_t>(1U << bit);
        }
    }
    sums.push_back(quick({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}));
    sums.push_back(quick({9, 10, 11, 12, 13, 14, 15, 16, 1, 2, 3, 4, 5, 6, 7, 8}));
    std::sort(sums.begin(), sums.end());
    CHECK(std::unique(sums.begin(), sums.end()) == sums.end());
    CHECK(sums.front().size() == 16);
}

TEST_CASE("fingerprints differ where a name or a value does")
{
    const Facts before{{"matcher.p2", "192"}, {"geometry.kind", "rectified"}, {"old", "1"}};
    CHECK(differences(before, before).empty());
    CHECK(differences(before,
                      {{"matcher.p2", "160"}, {"geometry.kind", "rectified"}, {"new", ""}}) ==
          std::vector<std::string>{"matcher.p2: 192 before, 160 now",
                                   "new: absent before, empty now",
                                   "old: 1 before, absent now"});
}
