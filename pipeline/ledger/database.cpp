#include "pipeline/ledger/database.h"

#include <sqlite3.h>

namespace hsgm::ledger {

namespace {

// Readers take moments, and so do commits; a network file system may take its time. Who only
// looks can do without (read_ledger), and does not wait as long.
constexpr int kWriterWaitsMs = 30'000;
constexpr int kReaderWaitsMs = 2'000;

bool is_damage(int code)
{
    return code == SQLITE_CORRUPT || code == SQLITE_NOTADB;
}

int flags_of(Database::Access access)
{
    // For reading, too: SQLite falls back where the file may not be written to.
    return SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX |
           (access == Database::Access::read ? 0 : SQLITE_OPEN_CREATE);
}

const char* settings_of(Database::Access access)
{
    switch (access) {
    case Database::Access::make:
        return "PRAGMA journal_mode = DELETE; PRAGMA synchronous = FULL";
    case Database::Access::fleeting:
        return "PRAGMA journal_mode = DELETE; PRAGMA synchronous = OFF";
    case Database::Access::read:
        break;
    }
    return "PRAGMA query_only = ON";
}

} // namespace

Database::Database(const std::filesystem::path& path, Access access) : path_(path)
{
    const int code = sqlite3_open_v2(path.c_str(), &handle_,
                                     flags_of(access) | SQLITE_OPEN_NOMUTEX, nullptr);
    try {
        if (code != SQLITE_OK) {
            fail(code);
        }
        sqlite3_busy_timeout(handle_, access == Access::read ? kReaderWaitsMs : kWriterWaitsMs);
        execute(settings_of(access));
    } catch (...) {
        sqlite3_close(handle_);
        throw;
    }
}

Database::~Database()
{
    sqlite3_close(handle_);
}

void Database::fail(int code) const
{
    const std::string words =
        handle_ != nullptr ? sqlite3_errmsg(handle_) : sqlite3_errstr(code);
    const int kind = code & 0xFF;
    if (is_damage(kind)) {
        throw DamagedError("The ledger " + path_.string() +
                           " is damaged (SQLite says: " + words + ").");
    }
    if (kind == SQLITE_BUSY) {
        throw BusyError("The ledger " + path_.string() +
                        " is kept locked by another process (SQLite says: " + words +
                        "); look for one that hangs.");
    }
    const std::string advice = kind == SQLITE_FULL
                                   ? "; make room on that disk and resume the run."
                                   : "; look for a full, failing or read-only disk.";
    throw io::StorageError("Cannot use the ledger " + path_.string() +
                           " (SQLite says: " + words + ")" + advice);
}

void Database::execute(const char* sql)
{
    const int code = sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr);
    if (code != SQLITE_OK) {
        fail(code);
    }
}

void Database::check_whole()
{
    Statement check(*this, "PRAGMA quick_check(1)");
    if (!check.step() || check.text(0) != "ok") {
        throw DamagedError("The ledger " + path_.string() + " does not hold together.");
    }
}

Statement::Statement(Database& database, const char* sql) : database_(database)
{
    check(sqlite3_prepare_v2(database.handle_, sql, -1, &handle_, nullptr));
}

Statement::~Statement()
{
    sqlite3_finalize(handle_);
}

void Statement::check(int code) const
{
    if (code != SQLITE_OK) {
        database_.fail(code);
    }
}

Statement& Statement::bind(std::int64_t value)
{
    check(sqlite3_bind_int64(handle_, ++bound_, value));
    return *this;
}

Statement& Statement::bind(double value)
{
    check(sqlite3_bind_double(handle_, ++bound_, value));
    return *this;
}

Statement& Statement::bind(const std::string& value)
{
    check(sqlite3_bind_text(handle_, ++bound_, value.data(), static_cast<int>(value.size()),
                            SQLITE_TRANSIENT));
    return *this;
}

bool Statement::step()
{
    const int code = sqlite3_step(handle_);
    if (code == SQLITE_ROW) {
        return true;
    }
    bound_ = 0;
    const int reset = sqlite3_reset(handle_);
    if (code != SQLITE_DONE) {
        database_.fail(reset != SQLITE_OK ? reset : code);
    }
    return false;
}

std::int64_t Statement::integer(int column) const
{
    return sqlite3_column_int64(handle_, column);
}

double Statement::number(int column) const
{
    return sqlite3_column_double(handle_, column);
}

std::string Statement::text(int column) const
{
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(handle_, column));
    return text == nullptr
               ? ""
               : std::string(text,
                             static_cast<std::size_t>(sqlite3_column_bytes(handle_, column)));
}

Transaction::Transaction(Database& database) : database_(database)
{
    database_.execute("BEGIN IMMEDIATE");
}

Transaction::~Transaction()
{
    if (open_) {
        try {
            database_.execute("ROLLBACK");
        } catch (const std::exception&) {
            // SQLite has rolled back already, or will when the file is opened next.
            open_ = false;
        }
    }
}

void Transaction::commit()
{
    database_.execute("COMMIT");
    open_ = false;
}

} // namespace hsgm::ledger
