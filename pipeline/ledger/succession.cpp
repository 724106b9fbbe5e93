#include "pipeline/ledger/succession.h"

#include "pipeline/ledger/database.h"

#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <string>
#include <system_error>
#include <thread>

namespace hsgm::ledger {

namespace {

namespace fs = std::filesystem;

constexpr int kTries = 40;
constexpr auto kPause = std::chrono::milliseconds(50);

fs::path journal_of(const fs::path& path)
{
    return path.string() + "-journal";
}

// "x" and 1 of "x.sqlite"; "x" and 3 of "x.3.sqlite".
struct NumberedName {
    fs::path first;
    int number = 1;
};

NumberedName parsed(const fs::path& path)
{
    const fs::path stem = path.stem();
    const std::string ending = stem.extension().string();
    int number = 0;
    if (ending.size() > 1) {
        const char* const end = ending.data() + ending.size();
        const auto [rest, error] = std::from_chars(ending.data() + 1, end, number);
        if (error == std::errc() && rest == end && number > 1) {
            return {path.parent_path() / stem.stem(), number};
        }
    }
    return {path.parent_path() / stem, 1};
}

fs::path numbered(const NumberedName& name, const fs::path& extension)
{
    fs::path path = name.first;
    if (name.number > 1) {
        path += '.';
        path += std::to_string(name.number);
    }
    path += extension;
    return path;
}

// What a writer cannot change without its showing, for it writes both files in turn.
struct Stamp {
    std::uintmax_t bytes = 0;
    fs::file_time_type written{};
    bool has_journal = false;
    std::uintmax_t journal_bytes = 0;
    fs::file_time_type journal_written{};

    bool operator==(const Stamp&) const = default;
};

Stamp stamp_of(const fs::path& path)
{
    Stamp stamp;
    stamp.bytes = fs::file_size(path);
    stamp.written = fs::last_write_time(path);
    std::error_code none;
    stamp.has_journal = fs::exists(journal_of(path), none);
    if (stamp.has_journal) {
        stamp.journal_bytes = fs::file_size(journal_of(path));
        stamp.journal_written = fs::last_write_time(journal_of(path));
    }
    return stamp;
}

void remove_copy(const fs::path& copy)
{
    std::error_code none;
    fs::remove(copy, none);
    fs::remove(journal_of(copy), none);
}

// False: somebody wrote meanwhile.
bool try_to_copy(const fs::path& from, const fs::path& to)
{
    try {
        const Stamp before = stamp_of(from);
        fs::copy_file(from, to, fs::copy_options::overwrite_existing);
        if (before.has_journal) {
            fs::copy_file(journal_of(from), journal_of(to),
                          fs::copy_options::overwrite_existing);
        }
        return stamp_of(from) == before;
    } catch (const fs::filesystem_error& error) {
        if (error.code() == std::errc::no_such_file_or_directory && fs::exists(from)) {
            return false; // a journal that has just gone
        }
        throw io::StorageError("Cannot copy the ledger " + from.string() + ": " +
                               error.code().message() + ".");
    }
}

} // namespace

fs::path successor_of(const fs::path& path)
{
    NumberedName name = parsed(path);
    ++name.number;
    return numbered(name, path.extension());
}

int number_of_successions(const fs::path& path)
{
    return parsed(path).number - 1;
}

fs::path latest_of(const fs::path& first)
{
    fs::path latest = first;
    std::error_code none;
    for (fs::path next = successor_of(latest); fs::exists(next, none);
         next = successor_of(next)) {
        latest = next;
    }
    return latest;
}

void copy_ledger(const fs::path& from, const fs::path& to)
{
    bool whole = false;
    try {
        for (int i = 0; i < kTries && !whole; ++i) {
            remove_copy(to);
            whole = try_to_copy(from, to);
            if (!whole) {
                std::this_thread::sleep_for(kPause);
            }
        }
        if (!whole) {
            throw io::StorageError("Cannot copy the ledger " + from.string() +
                                   ": another process writes to it all the time.");
        }
        // Opening it takes back what the journal tells of.
        Database(to, Database::Access::make).check_whole();
    } catch (...) {
        remove_copy(to);
        throw;
    }
}

bool publish_successor(const fs::path& copy, const fs::path& successor)
{
    // Unlike a rename, a link never replaces what is there.
    const bool first = ::link(copy.c_str(), successor.c_str()) == 0;
    const int error = errno;
    remove_copy(copy);
    if (!first && error != EEXIST) {
        throw io::StorageError("Cannot make the ledger " + successor.string() + ": " +
                               std::generic_category().message(error) + ".");
    }
    return first;
}

} // namespace hsgm::ledger
