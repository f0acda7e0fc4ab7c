//! COCO's JSON: images, categories, annotations; `track_id` says which are the same object, as video tools extend the format.

use serde_json::{Value, json};

use super::Tracks;

pub(super) fn json(tracks: &Tracks<'_>) -> String {
    let about = tracks.about;
    let images: Vec<Value> = about
        .labels
        .iter()
        .enumerate()
        .map(|(index, label)| {
            json!({"id": index + 1, "file_name": label, "width": about.width, "height": about.height,
                   "video_id": 1, "frame_id": index})
        })
        .collect();
    let classes = tracks.classes();
    let categories: Vec<Value> = classes
        .iter()
        .enumerate()
        .map(|(index, class)| json!({"id": index + 1, "name": class, "supercategory": ""}))
        .collect();
    let annotations: Vec<Value> = tracks
        .boxes()
        .enumerate()
        .map(|(index, (frame, number, object, found))| {
            let rect = found.box_in_frame;
            json!({
                "id": index + 1, "image_id": frame + 1, "category_id": tracks.class_of(object) + 1,
                "track_id": number + 1, "bbox": [rect.x, rect.y, rect.w, rect.h], "area": rect.area(),
                "segmentation": [], "iscrowd": 0, "score": found.confidence,
                "attributes": {"name": object.name, "key": found.is_key},
            })
        })
        .collect();
    let whole = json!({
        "info": {"description": about.name}, "licenses": [],
        "videos": [{"id": 1, "name": about.name, "width": about.width, "height": about.height}],
        "images": images, "categories": categories, "annotations": annotations,
    });
    whole.to_string() + "\n"
}
