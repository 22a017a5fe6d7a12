/* object_check.c - notes of `mimdsim cc` in object files and in members of archives. */
#include "compile/object_check.h"

#include <ar.h>
#include <elf.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "loader/block_table.h"

/* --- object files: gABI chapter 4 --- */

/* A file in memory: offsets that point out of it end the search, not the program. */
struct bytes {
    const char *s;
    size_t n;
};

/* NULL when the piece does not lie in the file as a whole. */
static const void *at(struct bytes b, uint64_t offset, uint64_t size)
{
    return offset <= b.n && size <= b.n - offset ? b.s + offset : NULL;
}

/* The name in a table of names, which must end within it. */
static const char *name_at(struct bytes names, uint32_t offset)
{
    return offset < names.n && memchr(names.s + offset, 0, names.n - offset) != NULL
               ? names.s + offset
               : "";
}

/* Sections such as .bss have a size but nothing in the file. */
static struct bytes section_bytes(struct bytes file, const Elf64_Shdr *s)
{
    const char *begin = s->sh_type == SHT_NOBITS ? NULL : at(file, s->sh_offset, s->sh_size);
    return (struct bytes){begin, begin != NULL ? s->sh_size : 0};
}

/* Whether the table has the symbol that a kernel in one file declares. */
static bool defines_program(struct bytes file, const Elf64_Shdr *section, int n,
                            const Elf64_Shdr *table)
{
    const struct bytes symbols = section_bytes(file, table);
    if (table->sh_link >= (unsigned)n) return false;
    const struct bytes names = section_bytes(file, &section[table->sh_link]);
    for (size_t k = 0; (k + 1) * sizeof(Elf64_Sym) <= symbols.n; k++) {
        Elf64_Sym symbol;
        memcpy(&symbol, symbols.s + k * sizeof symbol, sizeof symbol);
        if (symbol.st_shndx != SHN_UNDEF &&
            strcmp(name_at(names, symbol.st_name), "mimdsim_program") == 0)
            return true;
    }
    return false;
}

/* The header is looked at first, then each section once: code, our note, the declaration of a
 * kernel. */
struct object_facts object_facts(const void *content, size_t n)
{
    struct object_facts facts = {0};
    const struct bytes file = {content, n};
    Elf64_Ehdr header;
    if (n < sizeof header) return facts;
    memcpy(&header, content, sizeof header);
    if (memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_ident[EI_CLASS] != ELFCLASS64)
        return facts;
    const int count = header.e_shnum;
    const void *table = at(file, header.e_shoff, (uint64_t)count * sizeof(Elf64_Shdr));
    if (table == NULL || count == 0 || header.e_shentsize != sizeof(Elf64_Shdr) ||
        header.e_shstrndx >= count)
        return facts;
    /* A copy, as members of archives lie at odd addresses. */
    Elf64_Shdr *section = malloc((size_t)count * sizeof *section);
    if (section == NULL) return facts;
    memcpy(section, table, (size_t)count * sizeof *section);
    const struct bytes names = section_bytes(file, &section[header.e_shstrndx]);
    facts.is_object = true;
    for (int i = 0; i < count; i++) {
        const Elf64_Shdr *s = &section[i];
        /* An object may hold data only; then there is nothing to count. */
        if (s->sh_type == SHT_PROGBITS && (s->sh_flags & SHF_EXECINSTR) && s->sh_size > 0)
            facts.has_code = true;
        if (strcmp(name_at(names, s->sh_name), BLOCK_NOTE_SECTION) == 0) facts.counted = true;
        if (s->sh_type == SHT_SYMTAB && defines_program(file, section, count, s))
            facts.kernel = true;
    }
    free(section);
    return facts;
}

/* What cannot be read has no facts; the linker complains about it by itself. */
struct object_facts object_facts_of_file(const char *path)
{
    struct text file = {0};
    struct err e;
    err_clear(&e);
    struct object_facts facts = {0};
    if (text_read_file(&file, path, &e)) facts = object_facts(file.s, file.length);
    text_free(&file);
    return facts;
}

/* --- archives: ar(5), with GNU's table of long names --- */

/* Whether the name of a member, with its end "/", or "/123" into the table of long names, is
 * `name`. */
static bool is_member(const struct ar_hdr *h, struct bytes longer, const char *name)
{
    const size_t n = strlen(name);
    if (h->ar_name[0] != '/')
        return n < sizeof h->ar_name && memcmp(h->ar_name, name, n) == 0 && h->ar_name[n] == '/';
    const size_t offset = strtoul(h->ar_name + 1, NULL, 10);
    return offset + n < longer.n && memcmp(longer.s + offset, name, n) == 0 &&
           longer.s[offset + n] == '/';
}

/* Whether every member of that name is counted or without code. */
static bool member_is_fine(struct bytes archive, const char *name)
{
    struct bytes longer = {NULL, 0};
    size_t offset = SARMAG;
    if (archive.n < SARMAG || memcmp(archive.s, ARMAG, SARMAG) != 0)
        return true; /* a thin archive: its files */
    for (const struct ar_hdr *h; (h = at(archive, offset, sizeof *h)) != NULL;) {
        const size_t size = strtoul(h->ar_size, NULL, 10);
        const char *content = at(archive, offset + sizeof *h, size);
        if (content == NULL) break;
        if (strncmp(h->ar_name, "// ", 3) == 0) longer = (struct bytes){content, size};
        if (is_member(h, longer, name)) {
            const struct object_facts facts = object_facts(content, size);
            if (facts.has_code && !facts.counted) return false;
        }
        offset += sizeof *h + size + size % 2;
    }
    return true;
}

/* --- what the linker used --- */

/* The compiler's and the system's own libraries need no count: their functions are priced by
 * name (elementary_list.h) or not at all. realpath, as /lib is a link to /usr/lib on many
 * systems. */
static bool is_system(const char *path)
{
    static const char *const folder[] = {"/usr/lib/", "/lib/", "/usr/lib64/", "/lib64/",
                                         "/usr/libexec/"};
    char *real = realpath(path, NULL);
    const char *known = real != NULL ? real : path, *slash = strrchr(known, '/');
    bool system = strstr(known, "/lib/gcc/") != NULL ||
                  strncmp(slash != NULL ? slash + 1 : known, "libmimdsim-", 11) == 0;
    for (unsigned i = 0; i < sizeof folder / sizeof folder[0]; i++)
        system = system || strncmp(known, folder[i], strlen(folder[i])) == 0;
    free(real);
    return system;
}

/* By the member's name in its archive, or the object's. */
static bool refuse(const char *name, const char *in, struct err *e)
{
    return err_set(e, ERR_DATA,
                   "%s%s%s was not compiled by `mimdsim cc`, `c++` or `f90`: its computing time "
                   "would not be counted; compile it again with CC=\"mimdsim cc\"",
                   name, in != NULL ? " in " : "", in != NULL ? in : "");
}

/* One line of the linker's trace, ended by NUL. */
static bool check_line(char *line, struct err *e)
{
    char *close = line[0] == '(' ? strrchr(line, ')') : NULL;
    const char *path = close != NULL ? line + 1 : line;
    if (close != NULL) *close = '\0';
    if (path[0] == '\0' || is_system(path)) return true;
    struct text file = {0};
    struct err unread; /* what is no file is another message of the linker */
    err_clear(&unread);
    bool fine = true;
    if (text_read_file(&file, path, &unread)) {
        const struct bytes content = {file.s, file.length};
        if (close != NULL) fine = member_is_fine(content, close + 1) || refuse(close + 1, path, e);
        else {
            const struct object_facts facts = object_facts(file.s, file.length);
            fine = !facts.has_code || facts.counted || refuse(path, NULL, e);
        }
    }
    text_free(&file);
    return fine;
}

/* The trace has a line for each file that the linker opened, "(archive)member" for members. */
bool object_check_trace(const struct text *trace, struct err *e)
{
    for (char *line = trace->s; line != NULL && *line != '\0';) {
        char *end = strchr(line, '\n');
        if (end != NULL) *end = '\0';
        if (!check_line(line, e)) return false;
        line = end != NULL ? end + 1 : NULL;
    }
    return true;
}
