//! Dilation and erosion of a mask by a square, in a time that does not depend on the square's size.
//!
//! Steps:
//! 1. in each row, count the values wanted in a window that slides along it,
//! 2. down each column, count the windows of step 1 that had one, again in a window that slides; all columns of a row at once.

use image::GrayImage;

/// Gives `value` to every pixel that has one of that value within `reach` pixels by the chessboard distance. Beyond the
/// border there is none.
pub(super) fn spread(mask: &mut GrayImage, value: u8, reach: usize) {
    let (width, height) = (mask.width() as usize, mask.height() as usize);
    if width == 0 || height == 0 {
        return;
    }
    let mut near = vec![0u8; width * height];
    for (row, near) in mask.chunks_exact(width).zip(near.chunks_exact_mut(width)) {
        spread_in_row(row, near, value, reach);
    }
    let row_of = |y: usize| &near[y * width..][..width];
    let mut counts = vec![0u16; width];
    for y in 0..reach.min(height) {
        counts.iter_mut().zip(row_of(y)).for_each(|(count, &one)| *count += u16::from(one));
    }
    for (y, row) in mask.chunks_exact_mut(width).enumerate() {
        if y + reach < height {
            counts.iter_mut().zip(row_of(y + reach)).for_each(|(count, &one)| *count += u16::from(one));
        }
        if y > reach {
            counts.iter_mut().zip(row_of(y - reach - 1)).for_each(|(count, &one)| *count -= u16::from(one));
        }
        for (pixel, &count) in row.iter_mut().zip(&counts) {
            *pixel = if count > 0 { value } else { *pixel };
        }
    }
}

/// Step 1: 1 where the row has `value` within `reach`, else 0.
fn spread_in_row(row: &[u8], near: &mut [u8], value: u8, reach: usize) {
    let mut count = row.iter().take(reach).filter(|&&pixel| pixel == value).count();
    for (x, near) in near.iter_mut().enumerate() {
        count += usize::from(row.get(x + reach).is_some_and(|&pixel| pixel == value));
        count -= usize::from(x > reach && row[x - reach - 1] == value);
        *near = u8::from(count > 0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_spreads_to_a_square_that_the_border_cuts() {
        let mut mask = GrayImage::new(5, 4);
        mask.put_pixel(1, 0, image::Luma([9]));
        spread(&mut mask, 9, 1);
        let rows: Vec<&[u8]> = mask.chunks(5).collect();
        assert_eq!(rows, [[9, 9, 9, 0, 0], [9, 9, 9, 0, 0], [0; 5], [0; 5]]);
        spread(&mut mask, 0, 1);
        assert_eq!(mask.iter().filter(|&&pixel| pixel == 9).count(), 2);
        spread(&mut mask, 9, 50);
        assert!(mask.iter().all(|&pixel| pixel == 9));
        spread(&mut GrayImage::new(0, 0), 9, 3);
    }
}
