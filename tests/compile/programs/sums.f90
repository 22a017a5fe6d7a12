! sums.f90 - Fortran with array expressions, a select case and an internal procedure; guest() returns a checksum.
function guest() bind(c) result(total)
    use iso_c_binding
    implicit none
    integer(c_long) :: total
    real(8) :: a(12, 12), b(12), x
    integer :: i, j
    do j = 1, 12
        do i = 1, 12
            a(i, j) = 1d0 / (i + 2 * j)
        end do
        b(j) = sqrt(dble(j)) + sin(dble(j))
    end do
    x = sum(matmul(a, b)) + dot_product(b, b) + maxval(abs(b)) ** 3
    total = 0
    do i = 1, 12
        select case (mod(i, 6))
        case (0)
            total = total + 3
        case (1)
            total = total * 2 + chosen(i)
        case (2:3)
            total = ieor(total, 5_c_long)
        case default
            total = total + int(x * i)
        end select
    end do
contains
    integer function chosen(k)
        integer, intent(in) :: k
        chosen = merge(k, -k, b(k) > 2d0)
    end function
end function
