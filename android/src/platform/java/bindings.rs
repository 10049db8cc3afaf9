//! Bindings of Java classes, limited to the methods that are called.

use jni::bind_java_type;

bind_java_type! {
    pub Activity => android.app.Activity,
    type_map = {
        ContentResolver => android.content.ContentResolver,
        Intent => android.content.Intent,
        IntentFilter => android.content.IntentFilter,
        PackageManager => android.content.pm.PackageManager,
        Window => android.view.Window,
        WindowManager => android.view.WindowManager,
    },
    methods {
        fn check_self_permission(name: JString) -> jint,
        fn finish(),
        fn request_permissions(names: JString[], code: jint),
        fn start_activity(intent: Intent),
        fn get_application_context() -> android.content.Context,
        fn get_content_resolver() -> ContentResolver,
        fn get_intent() -> Intent,
        fn get_package_manager() -> PackageManager,
        fn get_system_service(name: JString) -> JObject,
        fn get_window() -> Window,
        fn get_window_manager() -> WindowManager,
        fn register_receiver(receiver: android.content.BroadcastReceiver, filter: IntentFilter) -> Intent,
    },
}

bind_java_type! {
    pub WindowManager => android.view.WindowManager,
    type_map = { Display => android.view.Display },
    methods { fn get_default_display() -> Display },
}

bind_java_type! {
    pub Display => android.view.Display,
    type_map = { Mode => "android.view.Display$Mode", DisplayMetrics => android.util.DisplayMetrics },
    methods {
        fn get_mode() -> Mode,
        fn get_real_metrics(metrics: DisplayMetrics),
        fn get_refresh_rate() -> jfloat,
        fn get_rotation() -> jint,
    },
}

bind_java_type! {
    pub Mode => "android.view.Display$Mode",
    methods {
        fn get_physical_height() -> jint,
        fn get_physical_width() -> jint,
    },
}

bind_java_type! {
    pub DisplayMetrics => android.util.DisplayMetrics,
    constructors { fn new() },
    fields {
        xdpi: jfloat,
        ydpi: jfloat,
        width_pixels: jint,
        height_pixels: jint,
    },
}

bind_java_type! {
    pub Window => android.view.Window,
    type_map = { LayoutParams => "android.view.WindowManager$LayoutParams", View => android.view.View },
    methods {
        fn get_attributes() -> LayoutParams,
        fn get_decor_view() -> View,
        fn set_attributes(attributes: LayoutParams),
        fn set_sustained_performance_mode(enable: bool),
    },
}

bind_java_type! {
    pub LayoutParams => "android.view.WindowManager$LayoutParams",
    fields { screen_brightness: jfloat },
}

bind_java_type! {
    pub View => android.view.View,
    methods { fn set_system_ui_visibility(visibility: jint) },
}

bind_java_type! {
    pub PackageManager => android.content.pm.PackageManager,
    methods { fn has_system_feature(name: JString, version: jint) -> bool },
}

bind_java_type! {
    pub PowerManager => android.os.PowerManager,
    methods {
        fn is_interactive() -> bool,
        fn is_sustained_performance_mode_supported() -> bool,
    },
}

bind_java_type! {
    pub BatteryManager => android.os.BatteryManager,
    methods { fn get_int_property(id: jint) -> jint },
}

bind_java_type! {
    pub Intent => android.content.Intent,
    type_map = { Bundle => android.os.Bundle, Parcelable => android.os.Parcelable, Uri => android.net.Uri },
    constructors { fn new(action: JString) },
    methods {
        static fn create_chooser(target: Intent, title: JCharSequence) -> Intent,
        fn get_action() -> JString,
        fn get_char_sequence_extra(name: JString) -> JCharSequence,
        fn get_data() -> Uri,
        fn get_extras() -> Bundle,
        fn get_flags() -> jint,
        fn get_int_extra(name: JString, default: jint) -> jint,
        fn get_parcelable_extra(name: JString) -> Parcelable,
        fn put_extra(name: JString, value: JString) -> Intent,
        fn set_type(kind: JString) -> Intent,
    },
}

bind_java_type! {
    pub IntentFilter => android.content.IntentFilter,
    constructors { fn new(action: JString) },
}

bind_java_type! {
    pub Parcelable => android.os.Parcelable,
}

bind_java_type! {
    pub Bundle => android.os.Bundle,
    methods {
        fn get(key: JString) -> JObject,
        fn key_set() -> JSet,
    },
}

bind_java_type! {
    pub Toast => android.widget.Toast,
    methods {
        static fn make_text(
            context: android.content.Context,
            text: JCharSequence,
            duration: jint,
        ) -> Toast,
        fn show(),
    },
}

bind_java_type! {
    pub ContentResolver => android.content.ContentResolver,
    type_map = {
        Cursor => android.database.Cursor,
        ParcelFileDescriptor => android.os.ParcelFileDescriptor,
        Uri => android.net.Uri,
    },
    methods {
        fn open_file_descriptor(uri: Uri, mode: JString) -> ParcelFileDescriptor,
        fn query(
            uri: Uri,
            projection: JString[],
            selection: JString,
            arguments: JString[],
            order: JString,
        ) -> Cursor,
    },
}

bind_java_type! {
    pub ParcelFileDescriptor => android.os.ParcelFileDescriptor,
    methods { fn detach_fd() -> jint },
}

bind_java_type! {
    pub Uri => android.net.Uri,
    methods { static fn parse(text: JString) -> Uri },
}

bind_java_type! {
    pub Cursor => android.database.Cursor,
    methods {
        fn close(),
        fn get_column_index(name: JString) -> jint,
        fn get_string(column: jint) -> JString,
        fn move_to_next() -> bool,
    },
}
