/* test_elf_file.c - a shared object written here word by word: read as it is, and refused with the
 * right reason when one or two words of it are wrong. */
#include <elf.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "loader/elf_file.h"
#include "support/scratch.h"

enum { TEXT_AT, DATA_AT, DYNAMIC_AT, TLS_AT, RELRO_AT, SPARE_AT, HEADERS = SPARE_AT + 16 };
enum { DATA_ADDRESS = 0x100000, NEEDED_ROOM = 80, RELRSZ = 35, RELR, RELRENT };

/* Where each tag stands in the dynamic section. */
enum place {
    TAG_NEEDED, TAG_STRTAB, TAG_STRSZ, TAG_SYMTAB, TAG_SYMENT, TAG_HASH, TAG_GNU_HASH, TAG_VERSYM,
    TAG_VERNEED, TAG_VERNEEDNUM, TAG_RELA, TAG_RELASZ, TAG_RELAENT, TAG_JMPREL, TAG_PLTRELSZ,
    TAG_PLTREL, TAG_RELR, TAG_RELRSZ, TAG_RELRENT, TAG_INIT_ARRAY, TAG_INIT_ARRAYSZ,
    TAG_FINI_ARRAY, TAG_FINI_ARRAYSZ, TAG_SONAME, TAG_RUNPATH, TAG_FLAGS, TAG_SPARE,
    PLACES = TAG_SPARE + NEEDED_ROOM
};

/* The names of the file; offset 0 is the empty one. */
static const char names[] = "\0libm.so.6\0wide.so\0/opt\0first\0second\0GLIBC_2.2.5\0GLIBC_2.34";
enum { LIBM = 1, SONAME = 11, RUNPATH = 19, FIRST = 24, SECOND = 30, OLD = 37, NEW = 49 };

/* The whole file. Its first segment holds all of it at address 0, so that addresses are offsets. */
struct object {
    Elf64_Ehdr h;
    Elf64_Phdr p[HEADERS];
    Elf64_Dyn dynamic[PLACES + 1];
    char strings[64];
    Elf64_Sym symbol[3];
    uint16_t version[4];
    Elf64_Verneed need[2];
    Elf64_Vernaux aux[3];
    Elf64_Rela rela[2], plt[1];
    uint64_t relr[2], functions[3];
    uint32_t hash[8];
    struct {
        uint32_t nbucket, first, nbloom, shift;
        uint64_t bloom;
        uint32_t bucket[2], chain[2];
    } gnu;
};

#define OFFSET(member) offsetof(struct object, member)

/* Only what the reader looks at differs from zero. */
static void make_headers(struct object *o)
{
    memcpy(o->h.e_ident, ELFMAG, SELFMAG);
    o->h.e_ident[EI_CLASS] = ELFCLASS64;
    o->h.e_ident[EI_DATA] = ELFDATA2LSB;
    o->h.e_type = ET_DYN;
    o->h.e_machine = EM_X86_64;
    o->h.e_phoff = OFFSET(p);
    o->h.e_phentsize = sizeof(Elf64_Phdr);
    o->h.e_phnum = HEADERS;
    o->p[TEXT_AT] = (Elf64_Phdr){.p_type = PT_LOAD,
                                 .p_flags = PF_R | PF_X,
                                 .p_filesz = sizeof *o,
                                 .p_memsz = sizeof *o,
                                 .p_align = 4096};
    o->p[DATA_AT] = (Elf64_Phdr){.p_type = PT_LOAD,
                                 .p_flags = PF_R | PF_W,
                                 .p_filesz = 64,
                                 .p_vaddr = DATA_ADDRESS,
                                 .p_memsz = 4096,
                                 .p_align = 4096};
    o->p[DYNAMIC_AT] = (Elf64_Phdr){
        .p_type = PT_DYNAMIC, .p_vaddr = OFFSET(dynamic), .p_filesz = sizeof o->dynamic};
    o->p[TLS_AT] = (Elf64_Phdr){
        .p_type = PT_TLS, .p_vaddr = DATA_ADDRESS, .p_filesz = 8, .p_memsz = 16, .p_align = 16};
    o->p[RELRO_AT] = (Elf64_Phdr){.p_type = PT_GNU_RELRO, .p_vaddr = DATA_ADDRESS, .p_memsz = 64};
    /* PT_NULL may stand anywhere and means nothing */
    for (int i = SPARE_AT; i < HEADERS; i++) o->p[i].p_type = PT_NULL;
}

static void make_dynamic(struct object *o)
{
    const Elf64_Dyn value[] = {
        [TAG_NEEDED] = {DT_NEEDED, {LIBM}},
        [TAG_STRTAB] = {DT_STRTAB, {OFFSET(strings)}},
        [TAG_STRSZ] = {DT_STRSZ, {sizeof names}},
        [TAG_SYMTAB] = {DT_SYMTAB, {OFFSET(symbol)}},
        [TAG_SYMENT] = {DT_SYMENT, {sizeof(Elf64_Sym)}},
        [TAG_HASH] = {DT_HASH, {OFFSET(hash)}},
        [TAG_GNU_HASH] = {DT_GNU_HASH, {OFFSET(gnu)}},
        [TAG_VERSYM] = {DT_VERSYM, {OFFSET(version)}},
        [TAG_VERNEED] = {DT_VERNEED, {OFFSET(need)}},
        [TAG_VERNEEDNUM] = {DT_VERNEEDNUM, {2}},
        [TAG_RELA] = {DT_RELA, {OFFSET(rela)}},
        [TAG_RELASZ] = {DT_RELASZ, {sizeof o->rela}},
        [TAG_RELAENT] = {DT_RELAENT, {sizeof(Elf64_Rela)}},
        [TAG_JMPREL] = {DT_JMPREL, {OFFSET(plt)}},
        [TAG_PLTRELSZ] = {DT_PLTRELSZ, {sizeof o->plt}},
        [TAG_PLTREL] = {DT_PLTREL, {DT_RELA}},
        [TAG_RELR] = {RELR, {OFFSET(relr)}},
        [TAG_RELRSZ] = {RELRSZ, {sizeof o->relr}},
        [TAG_RELRENT] = {RELRENT, {8}},
        [TAG_INIT_ARRAY] = {DT_INIT_ARRAY, {OFFSET(functions)}},
        [TAG_INIT_ARRAYSZ] = {DT_INIT_ARRAYSZ, {2 * 8}},
        [TAG_FINI_ARRAY] = {DT_FINI_ARRAY, {OFFSET(functions[2])}},
        [TAG_FINI_ARRAYSZ] = {DT_FINI_ARRAYSZ, {8}},
        [TAG_SONAME] = {DT_SONAME, {SONAME}},
        [TAG_RUNPATH] = {DT_RUNPATH, {RUNPATH}},
        [TAG_FLAGS] = {DT_FLAGS, {0}},
    };
    memcpy(o->dynamic, value, sizeof value);
}

/* Two symbols behind the empty one, each with a version of the same library. */
static void make_tables(struct object *o)
{
    memcpy(o->strings, names, sizeof names);
    o->symbol[1].st_name = FIRST;
    o->symbol[2].st_name = SECOND;
    o->version[1] = 2;
    o->version[2] = 0x8000 | 3; /* hidden */
    o->need[0] = (Elf64_Verneed){1, 1, LIBM, OFFSET(aux) - OFFSET(need), sizeof o->need[0]};
    o->need[1] = (Elf64_Verneed){1, 2, LIBM, OFFSET(aux[1]) - OFFSET(need[1]), 0};
    o->aux[0] = (Elf64_Vernaux){0, 0, 2, OLD, 0};
    o->aux[1] = (Elf64_Vernaux){0, 0, 4, OLD, sizeof o->aux[1]};
    o->aux[2] = (Elf64_Vernaux){0, 0, 3, NEW, 0};
    o->hash[0] = 1, o->hash[1] = 3;
    o->gnu.nbucket = 2, o->gnu.first = 1, o->gnu.nbloom = 1;
    o->gnu.bucket[0] = 1, o->gnu.bucket[1] = 2;
    o->gnu.chain[0] = 0x11, o->gnu.chain[1] = 0x21; /* odd: the end of a chain */
}

static struct object usual(void)
{
    struct object o;
    memset(&o, 0, sizeof o);
    make_headers(&o);
    make_dynamic(&o);
    make_tables(&o);
    return o;
}

static char folder[256];

static int make(void **state)
{
    (void)state;
    scratch_make(folder, sizeof folder);
    return 0;
}

static int remove_it(void **state)
{
    (void)state;
    scratch_remove(folder);
    return 0;
}

/* The first n bytes of an object, through a file as the reader wants it. */
static bool read_part(const struct object *o, size_t n, struct elf_file *f, struct err *e)
{
    char path[600];
    err_clear(e);
    scratch_path(path, sizeof path, folder, "object.so");
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(o, 1, n, out), n);
    assert_int_equal(fclose(out), 0);
    return elf_file_read(f, path, e);
}

static bool read_object(const struct object *o, struct elf_file *f, struct err *e)
{
    return read_part(o, sizeof *o, f, e);
}

static void an_object_is_read_as_it_is(void **state)
{
    (void)state;
    const struct object o = usual();
    struct elf_file f;
    struct err e;
    if (!read_object(&o, &f, &e)) fail_msg("%s", e.text);
    assert_int_equal(f.nsegment, 2);
    assert_int_equal(f.segment[1].p_vaddr, DATA_ADDRESS);
    assert_int_equal(f.tls.p_memsz, 16);
    assert_int_equal(f.relro.p_memsz, 64);
    assert_int_equal(f.nneeded, 1);
    assert_string_equal(f.needed[0], "libm.so.6");
    assert_string_equal(f.soname, "wide.so");
    assert_string_equal(f.runpath, "/opt");
    assert_int_equal(f.nsymbol, 3);
    assert_string_equal(elf_file_name(&f, f.symbol[2].st_name), "second");
    assert_int_equal(f.rela[0].n, 2);
    assert_int_equal(f.rela[1].n, 1);
    assert_int_equal(f.relr.n, 2);
    assert_int_equal(f.ninit, 2);
    assert_int_equal(f.nfini, 1);
    assert_int_equal(f.fini_array, OFFSET(functions[2]));
    assert_false(f.symbolic);
    elf_file_free(&f);
}

static void the_version_of_a_symbol_is_found_by_its_number(void **state)
{
    (void)state;
    struct object o = usual();
    struct elf_file f;
    struct err e;
    assert_true(read_object(&o, &f, &e));
    assert_null(elf_file_version(&f, 0)); /* local: no version */
    assert_string_equal(elf_file_version(&f, 1), "GLIBC_2.2.5");
    assert_string_equal(elf_file_version(&f, 2), "GLIBC_2.34"); /* though hidden */
    elf_file_free(&f);
    /* a file without versions takes any */
    o.dynamic[TAG_VERSYM].d_tag = DT_DEBUG;
    assert_true(read_object(&o, &f, &e));
    assert_null(elf_file_version(&f, 1));
    elf_file_free(&f);
}

static void symbols_are_counted_by_either_table(void **state)
{
    (void)state;
    struct object o = usual();
    struct elf_file f;
    struct err e;
    /* the old table says it in a word */
    o.dynamic[TAG_GNU_HASH].d_tag = DT_DEBUG;
    assert_true(read_object(&o, &f, &e));
    assert_int_equal(f.nsymbol, 3);
    elf_file_free(&f);
    /* no name in the new one: all symbols lie before its first */
    o = usual();
    o.gnu.first = 3;
    assert_true(read_object(&o, &f, &e));
    assert_int_equal(f.nsymbol, 3);
    elf_file_free(&f);
}

static void bytes_are_found_within_one_segment_only(void **state)
{
    (void)state;
    const struct object o = usual();
    struct elf_file f;
    struct err e;
    assert_true(read_object(&o, &f, &e));
    assert_ptr_equal(elf_file_at(&f, 0, 4, 1), f.bytes);
    assert_ptr_equal(elf_file_at(&f, DATA_ADDRESS + 8, 56, 8), f.bytes + 8);
    assert_null(elf_file_at(&f, DATA_ADDRESS + 8, 57, 8)); /* beyond the file's part */
    assert_null(elf_file_at(&f, DATA_ADDRESS + 9, 4, 8));  /* not aligned */
    assert_null(elf_file_at(&f, sizeof o, 1, 1));          /* in the gap */
    assert_null(elf_file_at(&f, UINT64_MAX, 2, 1));        /* the sum wraps */
    assert_null(elf_file_at(&f, 8, UINT64_MAX, 1));        /* the size wraps */
    assert_non_null(elf_file_at(&f, sizeof o - 1, 1, 1));  /* the last byte */
    elf_file_free(&f);
}

/* One word set to a value; size 0: none. */
struct patch {
    size_t at, size;
    uint64_t value;
};

#define HEADER(member, value_)                                                                     \
    {                                                                                              \
        OFFSET(h.member), sizeof(((Elf64_Ehdr *)0)->member), value_                                \
    }
#define SEGMENT(i, member, value_)                                                                 \
    {                                                                                              \
        OFFSET(p[i].member), sizeof(((Elf64_Phdr *)0)->member), value_                             \
    }
#define TAG(place, value_)                                                                         \
    {                                                                                              \
        OFFSET(dynamic[place].d_un.d_val), 8, value_                                               \
    }
#define ANOTHER(i, tag_, value_)                                                                   \
    {OFFSET(dynamic[TAG_SPARE + (i)].d_tag), 8, tag_},                                             \
    {                                                                                              \
        OFFSET(dynamic[TAG_SPARE + (i)].d_un.d_val), 8, value_                                     \
    }
#define WORD(member, bytes, value_)                                                                \
    {                                                                                              \
        OFFSET(member), bytes, value_                                                              \
    }
#define FAR (UINT64_C(1) << 47)

static const struct {
    struct patch patch[3];
    const char *text;
} wrong[] = {
    {{HEADER(e_ident[0], 0)}, "no ELF file"},
    {{WORD(h.e_ident[EI_CLASS], 1, ELFCLASS32)}, "made for another processor (32 bits)"},
    {{WORD(h.e_ident[EI_DATA], 1, ELFDATA2MSB)}, "must be made for x86-64"},
    {{HEADER(e_machine, EM_386)}, "made for i386;"},
    {{HEADER(e_machine, EM_AARCH64)}, "made for AArch64;"},
    {{HEADER(e_machine, EM_ARM)}, "for ARM;"}, {{HEADER(e_machine, EM_PPC64)}, "for PowerPC;"},
    {{HEADER(e_machine, EM_RISCV)}, "for RISC-V;"}, {{HEADER(e_machine, EM_S390)}, "for S/390;"},
    {{HEADER(e_machine, EM_68K)}, "made for another processor;"},
    {{HEADER(e_type, ET_REL)}, "an object file; link it with `mimdsim cc`"},
    {{HEADER(e_type, ET_EXEC)}, "an ordinary executable; link it with `mimdsim cc`"},
    {{HEADER(e_type, ET_CORE)}, "neither program nor library"},
    {{HEADER(e_phentsize, 32)}, "its program headers lie outside the file"},
    {{HEADER(e_phoff, OFFSET(p) + 4)}, "its program headers lie outside the file"},
    {{HEADER(e_phoff, FAR)}, "its program headers lie outside the file"},
    {{HEADER(e_phnum, 0xffff)}, "its program headers lie outside the file"},
    {{SEGMENT(TEXT_AT, p_filesz, FAR)}, "a segment lies outside the file (is it cut short?)"},
    {{SEGMENT(DATA_AT, p_offset, UINT64_MAX - 4095)}, "a segment lies outside the file"},
    {{SEGMENT(DATA_AT, p_memsz, 63)}, "a segment is larger in the file than in memory"},
    {{SEGMENT(DATA_AT, p_memsz, FAR)}, "a segment's address is out of range"},
    {{SEGMENT(DATA_AT, p_vaddr, FAR)}, "a segment's address is out of range"},
    {{SEGMENT(DATA_AT, p_vaddr, UINT64_C(1) << 40)}, "a segment's address is out of range"},
    {{SEGMENT(DATA_AT, p_vaddr, DATA_ADDRESS + 8)}, "a segment is not aligned to pages"},
    {{SEGMENT(DATA_AT, p_align, 4096 + 8)}, "a segment's alignment is no whole page"},
    {{SEGMENT(TEXT_AT, p_vaddr, UINT64_C(1) << 30)}, "does not begin near address 0"},
    {{SEGMENT(DATA_AT, p_vaddr, 0)}, "two segments share a page"},
    {{SEGMENT(TEXT_AT, p_flags, PF_R | PF_W), SEGMENT(DATA_AT, p_flags, PF_R | PF_X)},
     "program text behind data; link with GNU ld or LLVM lld"},
    {{SEGMENT(TEXT_AT, p_flags, PF_R | PF_W | PF_X)}, "a segment is writable and executable"},
    {{SEGMENT(TEXT_AT, p_type, PT_NULL), SEGMENT(DATA_AT, p_type, PT_NULL)},
     "nothing in it is to be loaded"},
    {{SEGMENT(DYNAMIC_AT, p_type, PT_NULL)}, "it is linked statically; link it with `mimdsim cc`"},
    {{SEGMENT(TLS_AT, p_align, 8192)}, "the segment of thread-locals is out of range"},
    {{SEGMENT(TLS_AT, p_align, 24)}, "the segment of thread-locals is out of range"},
    {{SEGMENT(TLS_AT, p_memsz, 4)}, "the segment of thread-locals is out of range"},
    {{SEGMENT(TLS_AT, p_memsz, FAR)}, "the segment of thread-locals is out of range"},
    {{SEGMENT(TLS_AT, p_vaddr, DATA_ADDRESS + 60)},
     "the first values of thread-locals lie outside the file"},
    {{SEGMENT(DYNAMIC_AT, p_vaddr, FAR)}, "its dynamic section lies outside the file"},
    {{SEGMENT(DYNAMIC_AT, p_vaddr, OFFSET(dynamic) + 4)}, "its dynamic section lies outside"},
    {{TAG(TAG_STRTAB, FAR)}, "its table of names lies outside the file"},
    {{TAG(TAG_STRSZ, FAR)}, "its table of names lies outside the file"},
    {{TAG(TAG_STRSZ, 0)}, "its table of names lies outside the file"},
    {{TAG(TAG_STRSZ, sizeof names - 1)}, "its table of names lies outside the file"},
    {{TAG(TAG_NEEDED, sizeof names)}, "the name of a library lies outside the file"},
    {{TAG(TAG_NEEDED, 0)}, "the name of a library lies outside the file"},
    {{TAG(TAG_SYMTAB, FAR)}, "its table of symbols lies outside the file"},
    {{TAG(TAG_SYMENT, 16)}, "its table of symbols lies outside the file"},
    {{TAG(TAG_GNU_HASH, FAR)}, "its table of symbols lies outside the file"},
    {{WORD(gnu.nbucket, 4, UINT32_MAX)}, "its table of symbols lies outside the file"},
    {{WORD(gnu.nbloom, 4, UINT32_MAX)}, "its table of symbols lies outside the file"},
    {{WORD(gnu.chain[1], 4, 0x20)}, "its table of symbols lies outside the file"},
    {{WORD(gnu.bucket[1], 4, UINT32_MAX)}, "its table of symbols lies outside the file"},
    {{WORD(symbol[2].st_name, 4, sizeof names)}, "the name of a symbol lies outside the file"},
    {{TAG(TAG_VERSYM, FAR)}, "its table of versions lies outside the file"},
    {{TAG(TAG_VERSYM, OFFSET(version) + 1)}, "its table of versions lies outside the file"},
    {{TAG(TAG_VERNEED, FAR)}, "its table of wanted versions lies outside the file"},
    {{WORD(need[0].vn_next, 4, UINT32_MAX)}, "its table of wanted versions lies outside the file"},
    {{WORD(need[0].vn_aux, 4, UINT32_MAX)}, "a wanted version lies outside the file"},
    {{WORD(aux[1].vna_next, 4, UINT32_MAX)}, "a wanted version lies outside the file"},
    {{WORD(aux[2].vna_name, 4, sizeof names)}, "a wanted version lies outside the file"},
    {{WORD(aux[1].vna_next, 4, 0)}, "a list of versions ends early"},
    {{TAG(TAG_VERNEEDNUM, 3)}, "a list of versions ends early"},
    {{ANOTHER(0, DT_RELSZ, 8)}, "relocations without addends"},
    {{ANOTHER(0, DT_TEXTREL, 1)}, "its text needs relocations; compile all of it with -fPIC"},
    {{TAG(TAG_FLAGS, DF_TEXTREL)}, "its text needs relocations; compile all of it with -fPIC"},
    {{TAG(TAG_RELAENT, 16)}, "relocations of another size"},
    {{TAG(TAG_PLTREL, DT_REL)}, "relocations of another size"},
    {{TAG(TAG_RELR, FAR)}, "its packed relocations lie outside the file"},
    {{TAG(TAG_RELRENT, 4)}, "its packed relocations lie outside the file"},
    {{TAG(TAG_RELA, FAR)}, "its relocations lie outside the file"},
    {{TAG(TAG_JMPREL, OFFSET(plt) + 4)}, "its relocations lie outside the file"},
    {{TAG(TAG_INIT_ARRAYSZ, FAR)}, "its table of constructors lies outside the file"},
    {{TAG(TAG_FINI_ARRAY, OFFSET(functions[2]) + 4)},
     "its table of constructors lies outside the file"},
};

static void what_is_wrong_is_told(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct object o = usual();
        struct elf_file f;
        struct err e;
        for (int k = 0; k < 3; k++) {
            const struct patch *p = &wrong[i].patch[k];
            memcpy((char *)&o + p->at, &p->value, p->size);
        }
        if (read_object(&o, &f, &e)) fail_msg("%zu: not refused: %s", i, wrong[i].text);
        assert_int_equal(e.kind, ERR_DATA);
        if (!strstr(e.text, wrong[i].text))
            fail_msg("%zu: '%s' instead of '%s'", i, e.text, wrong[i].text);
        /* the file is named, and nothing is kept */
        assert_non_null(strstr(e.file, "object.so"));
        assert_null(f.bytes);
    }
}

static void more_segments_or_libraries_than_there_is_room_for(void **state)
{
    (void)state;
    struct object o = usual();
    struct elf_file f;
    struct err e;
    for (int i = 0; i < NEEDED_ROOM; i++) o.dynamic[TAG_SPARE + i] = (Elf64_Dyn){DT_NEEDED, {LIBM}};
    assert_false(read_object(&o, &f, &e));
    assert_non_null(strstr(e.text, "it needs too many libraries"));
    o.dynamic[TAG_SPARE + ELF_NEEDED - 1].d_tag = DT_NULL;
    assert_true(read_object(&o, &f, &e));
    assert_int_equal(f.nneeded, ELF_NEEDED);
    elf_file_free(&f);

    o = usual();
    for (int i = SPARE_AT; i < HEADERS; i++) {
        o.p[i] = o.p[DATA_AT];
        o.p[i].p_vaddr = DATA_ADDRESS + (uint64_t)(i - SPARE_AT + 1) * 8192;
    }
    assert_false(read_object(&o, &f, &e));
    assert_non_null(strstr(e.text, "too many segments"));
    o.p[SPARE_AT + ELF_SEGMENTS - 2].p_type = PT_NULL;
    o.p[SPARE_AT + ELF_SEGMENTS - 1].p_type = PT_NULL;
    assert_true(read_object(&o, &f, &e));
    assert_int_equal(f.nsegment, ELF_SEGMENTS);
    elf_file_free(&f);
}

/* Wherever it claims to be. */
static void an_empty_segment_is_passed_over(void **state)
{
    (void)state;
    struct object o = usual();
    struct elf_file f;
    struct err e;
    o.p[SPARE_AT] = (Elf64_Phdr){.p_type = PT_LOAD, .p_vaddr = FAR, .p_offset = FAR};
    assert_true(read_object(&o, &f, &e));
    assert_int_equal(f.nsegment, 2);
    elf_file_free(&f);
    o.dynamic[TAG_FLAGS].d_un.d_val = DF_SYMBOLIC;
    assert_true(read_object(&o, &f, &e));
    assert_true(f.symbolic);
    elf_file_free(&f);
}

/* Whatever the length at which a file is cut, it is refused: its first segment is the whole. */
static void a_file_cut_short_is_refused_at_every_length(void **state)
{
    (void)state;
    const struct object o = usual();
    for (size_t n = 0; n < sizeof o; n += n < sizeof o.h ? 1 : 61) {
        struct elf_file f;
        struct err e;
        if (read_part(&o, n, &f, &e)) fail_msg("%zu bytes were taken for a whole file", n);
        assert_int_equal(e.kind, ERR_DATA);
    }
}

static void a_file_that_is_not_there_is_an_input_error(void **state)
{
    (void)state;
    struct elf_file f;
    struct err e;
    err_clear(&e);
    assert_false(elf_file_read(&f, "/nonexistent/object.so", &e));
    assert_int_equal(e.kind, ERR_NO_INPUT);
    elf_file_free(&f); /* an empty one is fine */
}

static void sections_are_found_by_name(void **state)
{
    (void)state;
    struct object o = usual();
    /* the spare part of the dynamic section is large enough, and nothing reads it there */
    Elf64_Shdr *s = (Elf64_Shdr *)&o.dynamic[TAG_SPARE + 2];
    struct elf_file f;
    struct err e;
    uint64_t address = 0, size = 0;
    s[0] = (Elf64_Shdr){.sh_offset = OFFSET(strings), .sh_size = sizeof names};
    s[1] = (Elf64_Shdr){
        .sh_name = FIRST, .sh_flags = SHF_ALLOC, .sh_addr = DATA_ADDRESS, .sh_size = 8};
    s[2] = (Elf64_Shdr){.sh_name = SECOND, .sh_addr = DATA_ADDRESS, .sh_size = 8};
    s[3] = (Elf64_Shdr){.sh_name = SONAME, .sh_flags = SHF_ALLOC, .sh_addr = FAR, .sh_size = 8};
    s[4] = (Elf64_Shdr){.sh_name = UINT32_MAX, .sh_flags = SHF_ALLOC};
    o.h.e_shoff = OFFSET(dynamic[TAG_SPARE + 2]);
    o.h.e_shentsize = sizeof *s;
    o.h.e_shnum = 5;
    assert_true(read_object(&o, &f, &e));
    assert_true(elf_file_section(&f, "first", &address, &size));
    assert_int_equal(address, DATA_ADDRESS);
    assert_int_equal(size, 8);
    assert_false(elf_file_section(&f, "second", &address, &size));  /* not loaded */
    assert_false(elf_file_section(&f, "wide.so", &address, &size)); /* outside the file */
    assert_false(elf_file_section(&f, "third", &address, &size));
    elf_file_free(&f);
}

/* Section headers are needed by nobody: wrong ones only hide what they name. */
static void wrong_section_headers_hide_sections(void **state)
{
    (void)state;
    static const struct patch patch[] = {
        HEADER(e_shentsize, 32),
        HEADER(e_shoff, 4),
        HEADER(e_shoff, FAR),
        HEADER(e_shnum, 0xffff),
        HEADER(e_shstrndx, 5),
        {OFFSET(dynamic[TAG_SPARE + 2]) + 24, 8, FAR},
        {OFFSET(dynamic[TAG_SPARE + 2]) + 32, 8, FAR},
    };
    for (size_t i = 0; i < sizeof patch / sizeof *patch; i++) {
        struct object o = usual();
        struct elf_file f;
        struct err e;
        uint64_t address, size;
        Elf64_Shdr *s = (Elf64_Shdr *)&o.dynamic[TAG_SPARE + 2];
        s[0] = (Elf64_Shdr){.sh_offset = OFFSET(strings), .sh_size = sizeof names};
        s[1] = (Elf64_Shdr){.sh_name = FIRST, .sh_flags = SHF_ALLOC, .sh_size = 8};
        o.h.e_shoff = OFFSET(dynamic[TAG_SPARE + 2]);
        o.h.e_shentsize = sizeof *s;
        o.h.e_shnum = 2;
        assert_true(read_object(&o, &f, &e));
        assert_true(elf_file_section(&f, "first", &address, &size));
        elf_file_free(&f);
        memcpy((char *)&o + patch[i].at, &patch[i].value, patch[i].size);
        assert_true(read_object(&o, &f, &e));
        if (elf_file_section(&f, "first", &address, &size)) fail_msg("%zu: found", i);
        elf_file_free(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_object_is_read_as_it_is),
        cmocka_unit_test(the_version_of_a_symbol_is_found_by_its_number),
        cmocka_unit_test(symbols_are_counted_by_either_table),
        cmocka_unit_test(bytes_are_found_within_one_segment_only),
        cmocka_unit_test(what_is_wrong_is_told),
        cmocka_unit_test(more_segments_or_libraries_than_there_is_room_for),
        cmocka_unit_test(an_empty_segment_is_passed_over),
        cmocka_unit_test(a_file_cut_short_is_refused_at_every_length),
        cmocka_unit_test(a_file_that_is_not_there_is_an_input_error),
        cmocka_unit_test(sections_are_found_by_name),
        cmocka_unit_test(wrong_section_headers_hide_sections),
    };
    return cmocka_run_group_tests(tests, make, remove_it);
}
