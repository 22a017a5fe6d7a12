/* elf_dynamic.c - what the dynamic section names, checked: afterwards no index and no offset leads
 * out of the file. */
#include "loader/elf_dynamic.h"

#include <string.h>

/* The values of the section as they stand in the file; tags as in gABI 5, figure 5-10. */
struct dynamic {
    uint64_t value[DT_NUM];
    uint64_t gnu_hash, versym, verneed, verneednum, flags_1;
    uint64_t relr, relr_size, relr_entry;
};

/* Relative relocations as bits (gABI, 2022), newer than some systems' elf.h. */
enum { TAG_RELRSZ = 35, TAG_RELR = 36, TAG_RELRENT = 37 };

/* One entry of the section. Tags above DT_NUM belong to the system's extensions, of which few
 * matter. */
static void take_value(struct elf_file *f, struct dynamic *d, const Elf64_Dyn *y)
{
    if (y->d_tag == DT_NEEDED) {
        if (f->nneeded < ELF_NEEDED) f->needed[f->nneeded] = (const char *)(uintptr_t)y->d_un.d_val;
        f->nneeded++;
        return;
    }
    if (y->d_tag >= 0 && y->d_tag < DT_NUM) d->value[y->d_tag] = y->d_un.d_val;
    switch (y->d_tag) {
    case DT_SYMBOLIC:
        f->symbolic = true;
        break;
    case DT_GNU_HASH:
        d->gnu_hash = y->d_un.d_val;
        break;
    case DT_VERSYM:
        d->versym = y->d_un.d_val;
        break;
    case DT_VERNEED:
        d->verneed = y->d_un.d_val;
        break;
    case DT_VERNEEDNUM:
        d->verneednum = y->d_un.d_val;
        break;
    case DT_RUNPATH:
        d->value[DT_RPATH] = y->d_un.d_val;
        break; /* the newer word for the same list */
    case TAG_RELR:
        d->relr = y->d_un.d_val;
        break;
    case TAG_RELRSZ:
        d->relr_size = y->d_un.d_val;
        break;
    case TAG_RELRENT:
        d->relr_entry = y->d_un.d_val;
        break;
    default:
        break;
    }
}

/* A text of the string table: its offset is in range, and the table ends in a zero. */
static const char *text_at(const struct elf_file *f, uint64_t offset)
{
    return offset < f->strings_size ? f->strings + offset : NULL;
}

/* Names first: entries of DT_NEEDED are offsets into their table, which may come later in the
 * section. */
static bool read_strings(struct elf_file *f, const struct dynamic *d, struct err *e)
{
    f->strings_size = d->value[DT_STRSZ];
    f->strings = elf_file_at(f, d->value[DT_STRTAB], f->strings_size, 1);
    if (!f->strings || f->strings_size == 0 || f->strings[f->strings_size - 1] != '\0')
        return elf_bad(f, e, "its table of names lies outside the file");
    if (f->nneeded > ELF_NEEDED) return elf_bad(f, e, "it needs too many libraries");
    for (int i = 0; i < f->nneeded; i++) {
        f->needed[i] = text_at(f, (uint64_t)(uintptr_t)f->needed[i]);
        if (!f->needed[i] || !f->needed[i][0])
            return elf_bad(f, e, "the name of a library lies outside the file");
    }
    if (d->value[DT_SONAME]) f->soname = text_at(f, d->value[DT_SONAME]);
    if (d->value[DT_RPATH]) f->runpath = text_at(f, d->value[DT_RPATH]);
    return true;
}

/* The number of symbols by the GNU hash table: the end of the chain of the highest bucket; there is
 * no other word of it. Its layout: four words, bloom filter, buckets, chains whose last entry is
 * odd. 0: damaged. */
static size_t count_by_gnu_hash(const struct elf_file *f, uint64_t address)
{
    const uint32_t *h = elf_file_at(f, address, 16, 8);
    if (!h) return 0;
    uint64_t nbucket = h[0], first = h[1], bloom = h[2];
    uint64_t at = address + 16 + 8 * bloom;
    const uint32_t *bucket = elf_file_at(f, at, 4 * nbucket, 4);
    if (!bucket) return 0;
    uint64_t highest = 0;
    for (uint64_t i = 0; i < nbucket; i++)
        if (bucket[i] > highest) highest = bucket[i];
    if (highest < first) return (size_t)first;
    for (at += 4 * nbucket;; highest++) {
        const uint32_t *chain = elf_file_at(f, at + 4 * (highest - first), 4, 4);
        if (!chain) return 0;
        if (*chain & 1) return (size_t)highest + 1;
    }
}

/* The number of symbols stands in the old hash table; files with only GNU's must be counted. All
 * names are looked at once here, so that nobody else has to. */
static bool read_symbols(struct elf_file *f, const struct dynamic *d, struct err *e)
{
    /* Compilers write one of the two tables, or both. */
    if (d->gnu_hash) f->nsymbol = count_by_gnu_hash(f, d->gnu_hash);
    else if (d->value[DT_HASH]) {
        const uint32_t *h = elf_file_at(f, d->value[DT_HASH], 8, 4);
        f->nsymbol = h ? h[1] : 0;
    }
    f->symbol = elf_file_at(f, d->value[DT_SYMTAB], f->nsymbol * sizeof *f->symbol, 8);
    if (f->nsymbol == 0 || !f->symbol || d->value[DT_SYMENT] != sizeof *f->symbol)
        return elf_bad(f, e, "its table of symbols lies outside the file");
    for (size_t i = 0; i < f->nsymbol; i++)
        if (!text_at(f, f->symbol[i].st_name))
            return elf_bad(f, e, "the name of a symbol lies outside the file");
    /* One number a symbol, where the file has versions at all. */
    if (d->versym) {
        f->version = elf_file_at(f, d->versym, f->nsymbol * sizeof *f->version, 2);
        if (!f->version) return elf_bad(f, e, "its table of versions lies outside the file");
    }
    return true;
}

/* The versions wanted of other files: a list of files, each with a list of versions, both by
 * relative offsets. */
static bool read_versions(struct elf_file *f, const struct dynamic *d, struct err *e)
{
    uint64_t at = d->verneed;
    for (uint64_t i = 0; i < d->verneednum; i++) {
        const Elf64_Verneed *need = elf_file_at(f, at, sizeof *need, 4);
        if (!need) return elf_bad(f, e, "its table of wanted versions lies outside the file");
        uint64_t aux = at + need->vn_aux;
        for (int k = 0; k < need->vn_cnt; k++) {
            const Elf64_Vernaux *v = elf_file_at(f, aux, sizeof *v, 4);
            if (!v || !text_at(f, v->vna_name))
                return elf_bad(f, e, "a wanted version lies outside the file");
            if (v->vna_next == 0 && k + 1 < need->vn_cnt)
                return elf_bad(f, e, "a list of versions ends early");
            aux += v->vna_next;
        }
        if (need->vn_next == 0 && i + 1 < d->verneednum)
            return elf_bad(f, e, "a list of versions ends early");
        at += need->vn_next;
    }
    f->verneed = d->verneed;
    f->nverneed = d->verneednum;
    return true;
}

/* The version's name of symbol i, so that the host's function of that version is taken; bit 15
 * only tells that it is hidden. */
const char *elf_file_version(const struct elf_file *f, size_t i)
{
    if (!f->version) return NULL;
    const uint16_t wanted = f->version[i] & 0x7fff;
    uint64_t at = f->verneed;
    /* By addresses, as read_versions went: what follows in memory may lie elsewhere in the file. */
    for (uint64_t n = 0; n < f->nverneed; n++) {
        const Elf64_Verneed *need = elf_file_at(f, at, sizeof *need, 4);
        uint64_t aux = at + need->vn_aux;
        for (int k = 0; k < need->vn_cnt; k++) {
            const Elf64_Vernaux *v = elf_file_at(f, aux, sizeof *v, 4);
            if ((v->vna_other & 0x7fff) == wanted) return elf_file_name(f, v->vna_name);
            aux += v->vna_next;
        }
        at += need->vn_next;
    }
    return NULL;
}

static bool read_relocations(struct elf_file *f, const struct dynamic *d, struct err *e)
{
    const uint64_t address[2] = {d->value[DT_RELA], d->value[DT_JMPREL]};
    const uint64_t bytes[2] = {d->value[DT_RELASZ], d->value[DT_PLTRELSZ]};
    if (d->value[DT_RELSZ])
        return elf_bad(f, e, "relocations without addends, which x86-64 does not have");
    if (d->value[DT_TEXTREL] || (d->value[DT_FLAGS] & DF_TEXTREL))
        return elf_bad(f, e, "its text needs relocations; compile all of it with -fPIC");
    if ((bytes[0] && d->value[DT_RELAENT] != sizeof(Elf64_Rela)) ||
        (bytes[1] && d->value[DT_PLTREL] != DT_RELA))
        return elf_bad(f, e, "relocations of another size");
    if (d->relr_size) {
        f->relr = (struct elf_table){elf_file_at(f, d->relr, d->relr_size, 8), d->relr_size / 8};
        if (!f->relr.at || d->relr_entry != 8)
            return elf_bad(f, e, "its packed relocations lie outside the file");
    }
    for (int k = 0; k < 2; k++) {
        if (bytes[k] == 0) continue;
        f->rela[k] = (struct elf_table){elf_file_at(f, address[k], bytes[k], 8),
                                        bytes[k] / sizeof(Elf64_Rela)};
        if (!f->rela[k].at) return elf_bad(f, e, "its relocations lie outside the file");
    }
    return true;
}

/* Constructors and destructors: one function of old, and arrays. */
static bool read_functions(struct elf_file *f, const struct dynamic *d, struct err *e)
{
    f->init = d->value[DT_INIT];
    f->fini = d->value[DT_FINI];
    f->init_array = d->value[DT_INIT_ARRAY];
    f->fini_array = d->value[DT_FINI_ARRAY];
    f->ninit = d->value[DT_INIT_ARRAYSZ] / 8;
    f->nfini = d->value[DT_FINI_ARRAYSZ] / 8;
    if ((f->ninit && !elf_file_at(f, f->init_array, 8 * f->ninit, 8)) ||
        (f->nfini && !elf_file_at(f, f->fini_array, 8 * f->nfini, 8)))
        return elf_bad(f, e, "its table of constructors lies outside the file");
    return true;
}

/* Values first, as they stand in any order; then each table that they name, checked as a whole. */
bool elf_dynamic_read(struct elf_file *f, const Elf64_Phdr *dynamic, struct err *e)
{
    struct dynamic d = {0};
    const Elf64_Dyn *y = elf_file_at(f, dynamic->p_vaddr, dynamic->p_filesz, 8);
    if (!y) return elf_bad(f, e, "its dynamic section lies outside the file");
    const size_t n = dynamic->p_filesz / sizeof *y;
    for (size_t i = 0; i < n && y[i].d_tag != DT_NULL; i++) take_value(f, &d, &y[i]);
    if (d.value[DT_FLAGS] & DF_SYMBOLIC) f->symbolic = true;
    return read_strings(f, &d, e) && read_symbols(f, &d, e) && read_versions(f, &d, e) &&
           read_relocations(f, &d, e) && read_functions(f, &d, e);
}
